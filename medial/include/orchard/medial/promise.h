#pragma once
#include <optional>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"

// Checks whether a medial mesh keeps what its builder promises.
namespace orchard {

// What the builder of a medial mesh promises. Lengths are fractions of the diagonal of the surface's bounding box. A
// member without a value is not promised.
struct AxisPromise {
  // No place of the surface is farther than this from the balls, cones and slabs of the mesh.
  std::optional<double> open;
  // No ball, cone or slab extends out of the solid by more than this.
  std::optional<double> protrusion;
  bool topology = false;  // Whether the mesh has the Betti numbers of the solid.
};

// A promise, and what was found on the finished mesh. Lengths are fractions of the diagonal.
struct PromiseCheck {
  AxisPromise promise;
  // The largest values found above the promised ones; 0 if there are none.
  double open = 0, protrusion = 0;
  // Proven upper bounds, up to rounding; 0 where nothing was promised. If a bound is above the promised value while the
  // value found is 0, the search ended undecided: see proven().
  double open_upper = 0, protrusion_upper = 0;
  Topology found, wanted;  // Of the mesh, and of the solid.

  bool keeps_open() const { return open == 0; }
  bool keeps_protrusion() const { return protrusion == 0; }
  bool keeps_topology() const { return !promise.topology || found == wanted; }
  // Returns whether nothing that was promised is disproved.
  bool kept() const { return keeps_open() && keeps_protrusion() && keeps_topology(); }
  // Returns whether everything that was promised is proven.
  bool proven() const {
    return kept() && open_upper <= promise.open.value_or(open_upper) &&
           protrusion_upper <= promise.protrusion.value_or(protrusion_upper);
  }
};

// Compares a medial mesh with a promise. The topology is computed exactly. Lengths are searched by branch and bound
// over the surface and over the cells of the mesh, for values above the promised ones only.
// Throws InputError unless surface.solid() and validate(mesh) passes. If the promise holds, this costs about one
// nearest-place query for each triangle of the surface and of the mesh. The work is parallel, with the same result on
// any number of threads.
PromiseCheck check_promise(const Surface& surface, const MedialMesh& mesh, const AxisPromise& promise,
                           const Progress& progress = {});

}  // namespace orchard
