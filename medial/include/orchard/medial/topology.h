#pragma once
#include <cstdint>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {

// The Betti numbers of a complex or a solid. A medial axis has those of its solid (Lieutier 2004).
struct Topology {
  std::int64_t components = 0;
  std::int64_t loops = 0;     // independent ones: one for each handle
  std::int64_t cavities = 0;  // voids enclosed

  std::int64_t euler_characteristic() const { return components - loops + cavities; }
  bool operator==(const Topology&) const = default;
};

// Of the solid inside a surface, from its components' orientations and Euler characteristics. Throws InputError unless
// surface.solid().
Topology solid_topology(const Surface& surface);

// Over the field with two elements. Collapses what can be collapsed and reduces the boundary matrix of the rest; O(n)
// for most axes, whose rest is next to nothing. Precondition: validate(mesh) passes.
Topology topology(const MedialMesh& mesh);

}  // namespace orchard
