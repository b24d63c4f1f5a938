#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard::bench {

// A merged tree of depth 3 from 5000 surface points, grown until it covers; no sphere is removed.
SphereTree merged_tree(const Surface& surface);

// CPU seconds of this process so far.
double cpu_seconds();

}  // namespace orchard::bench
