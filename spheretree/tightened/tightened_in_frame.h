#pragma once
#include "orchard/spheretree/tightened.h"
#include "sets/weight_field.h"

namespace orchard::detail {

// Builds tightened_tree() for a surface in its frame, with points that were sampled there or moved there
// (canonical_frame.h). `weights` are in that frame and say where looseness counts more.
TightenBuild tightened_in_frame(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options,
                                const Progress& progress, const WeightField& weights = {});

}  // namespace orchard::detail
