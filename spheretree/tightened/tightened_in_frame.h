#pragma once
#include "orchard/spheretree/tightened.h"
#include "sets/weight_field.h"

namespace orchard::detail {

// tightened_tree() of a surface in its frame, with points that were made there or taken there (canonical_frame.h).
// `weights`: in that frame, where looseness counts more.
TightenBuild tightened_in_frame(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options,
                                const Progress& progress, const WeightField& weights = {});

}  // namespace orchard::detail
