#include "orchard/medial/refine.h"

#include "orchard/geometry/error.h"
#include "refiner.h"

namespace orchard {

RefinedAxis refine_axis(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis,
                        const RefineOptions& options, const Progress& progress) {
  if (!surface.solid())
    throw InputError("the medial axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
  detail::Refiner refiner(surface, sampling, axis, options, progress);
  refiner.refine();
  return refiner.finish();
}

}  // namespace orchard
