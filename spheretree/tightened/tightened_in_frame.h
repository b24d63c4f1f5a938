#pragma once
#include "orchard/spheretree/tightened.h"

namespace orchard::detail {

// tightened_tree() of a surface in its frame, with points that were made there or taken there (canonical_frame.h).
TightenBuild tightened_in_frame(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options,
                                const Progress& progress);

}  // namespace orchard::detail
