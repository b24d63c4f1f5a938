#pragma once
#include <string>

#include "input/load_solid.h"
#include "orchard/spheretree/build.h"

namespace orchard::apps {

// What is wrong with the medial axis of a certified tree, and whether the tree may be worse for it, in a line that says
// what to do about it; empty if nothing is known: cell faces that cross gaps after the repair, an axis in more or fewer
// pieces than the solid.
std::string build_doubts(const SolidMesh& solid, const SphereTreeBuild& result);

}  // namespace orchard::apps
