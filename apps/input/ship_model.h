#pragma once
#include "orchard/runtime/packed_tree.h"

namespace orchard::apps {

// Returns the tree of a small arrow-shaped ship with its nose along x. It is used if no tree is given.
runtime::PackedSphereTree ship_tree();

}  // namespace orchard::apps
