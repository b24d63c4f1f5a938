#pragma once
#include <optional>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"

namespace orchard {

// What the maker of a medial mesh promises of it. Lengths are fractions of the diagonal of the surface's bounding box.
// What has no value is not promised.
struct AxisPromise {
  std::optional<double> open;        // no place of the surface is farther from the mesh's balls, cones and slabs
  std::optional<double> protrusion;  // none of these sticks out of the solid by more
  bool topology = false;             // the mesh has the Betti numbers of the solid
};

// A promise beside what was found on the finished mesh. Lengths are fractions of the diagonal.
struct PromiseCheck {
  AxisPromise promise;
  // The largest values that were found, where they are above what was promised; otherwise 0.
  double open = 0, protrusion = 0;
  // Proven bounds, up to rounding: no value is larger. 0 where nothing was promised. A bound above what was promised,
  // beside a value of 0, means that the search ended undecided: see proven().
  double open_upper = 0, protrusion_upper = 0;
  Topology found, wanted;  // of the mesh; of the solid

  bool keeps_open() const { return open == 0; }
  bool keeps_protrusion() const { return protrusion == 0; }
  bool keeps_topology() const { return !promise.topology || found == wanted; }
  // Nothing that was promised is disproved.
  bool kept() const { return keeps_open() && keeps_protrusion() && keeps_topology(); }
  // Everything that was promised is proven.
  bool proven() const {
    return kept() && open_upper <= promise.open.value_or(open_upper) &&
           protrusion_upper <= promise.protrusion.value_or(protrusion_upper);
  }
};

// Compares a medial mesh with a promise: its topology exactly, lengths by branch and bound over the surface and over
// the mesh's cells, which looks only for values above the promised ones. About one nearest-place query for each
// triangle of the surface and of the mesh if the promise holds. Parallel; the same for any number of threads. Throws
// InputError unless surface.solid() and validate(mesh) passes.
PromiseCheck check_promise(const Surface& surface, const MedialMesh& mesh, const AxisPromise& promise,
                           const Progress& progress = {});

}  // namespace orchard
