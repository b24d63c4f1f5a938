#pragma once
#include <string>

#include "load_solid.h"
#include "orchard/spheretree/build.h"

namespace orchard::apps {

// What a certified tree may still be worse for than it need be, in a line that says what to do about it; empty if
// nothing is known: cell faces that cross gaps after the repair, an axis in more or fewer pieces than the solid.
std::string build_doubts(const SolidMesh& solid, const SphereTreeBuild& result);

}  // namespace orchard::apps
