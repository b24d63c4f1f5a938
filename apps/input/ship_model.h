#pragma once
#include "orchard/runtime/packed_tree.h"

namespace orchard::apps {

// The tree of a small arrow-shaped ship, nose along x, for those who have none of their own at hand.
runtime::PackedSphereTree ship_tree();

}  // namespace orchard::apps
