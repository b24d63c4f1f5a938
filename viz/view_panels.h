#pragma once
#include "panels.h"
#include "view_parts.h"

namespace orchard::detail {

// A panel for each level of the trees, or one if there is no tree, and so for each Voronoi diagram; everything else is
// in all of them.
Panels view_panels(const ViewParts& parts, const PanelOptions& options);

}  // namespace orchard::detail
