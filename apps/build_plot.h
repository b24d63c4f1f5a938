#pragma once
#include <string>

#include "orchard/spheretree/build.h"

namespace orchard::apps {

// A build's report as an SVG chart: inaccuracy and outside volume by level beside the octree's, and a histogram of the
// inaccuracy on each level below the root.
std::string build_plot(const SphereTreeBuild& result, const Surface& surface, const std::string& title);

}  // namespace orchard::apps
