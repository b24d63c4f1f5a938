#pragma once
#include <cstdint>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

// Betti numbers of solids and medial meshes.
namespace orchard {

// The Betti numbers of a complex or a solid. A medial axis has the Betti numbers of its solid (Lieutier 2004).
struct Topology {
  std::int64_t components = 0;
  std::int64_t loops = 0;     // Independent loops: one for each handle.
  std::int64_t cavities = 0;  // Enclosed voids.

  std::int64_t euler_characteristic() const { return components - loops + cavities; }
  bool operator==(const Topology&) const = default;
};

// Returns the Betti numbers of the solid inside a surface, from the orientations and Euler characteristics of its
// components. Throws InputError unless surface.solid().
Topology solid_topology(const Surface& surface);

// Returns the Betti numbers of a medial mesh over the field with two elements. Precondition: validate(mesh) passes. The
// function collapses cells from their free sides as far as possible, and reduces the boundary matrix of the rest. It
// takes O(n) for most axes, because almost nothing is left after collapsing.
Topology topology(const MedialMesh& mesh);

}  // namespace orchard
