#pragma once
#include <string>

#include "load_solid.h"
#include "orchard/medial/build.h"
#include "orchard/medial/topology.h"

namespace orchard::apps {

// What is wrong with an axis that was built, why, and what to do about it, in a line; empty if nothing is: another
// topology than the solid's, or parts left out to keep it.
std::string medial_warning(const SolidMesh& solid, const MedialBuild& build, const Topology& found,
                           const Topology& wanted, bool mended);

}  // namespace orchard::apps
