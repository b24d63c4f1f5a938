#pragma once
#include <string>
#include <vector>

#include "orchard/spheretree/build.h"
#include "svg_plot.h"

namespace orchard::apps {

// A build's report as charts: inaccuracy and outside volume by level beside the octree's, and a histogram of the
// inaccuracy on each level below the root.
std::vector<plot::Plot> build_plots(const SphereTreeBuild& result, const Surface& surface, const std::string& title);

}  // namespace orchard::apps
