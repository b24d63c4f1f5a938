#pragma once
#include "panels.h"
#include "view_parts.h"

namespace orchard::detail {

// The contents of one panel.
struct PanelParts {
  ViewParts parts;
  int level = -1;  // the level of its trees; -1 if there are none
};
std::vector<PanelParts> panel_parts(const ViewParts& parts, const FigureOptions& figure);

// Makes a panel for each level of the trees, or one if there is no tree, and so for each Voronoi diagram. Everything
// else is in all of them.
Panels view_panels(const ViewParts& parts, const PanelOptions& options);

}  // namespace orchard::detail
