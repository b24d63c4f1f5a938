#pragma once
#include "panels.h"
#include "view_parts.h"

namespace orchard::detail {

// What one panel shows.
struct PanelParts {
  ViewParts parts;
  int level = -1;  // of its trees; -1: there are none
};
std::vector<PanelParts> panel_parts(const ViewParts& parts, const FigureOptions& figure);

// A panel for each level of the trees, or one if there is no tree, and so for each Voronoi diagram; everything else is
// in all of them.
Panels view_panels(const ViewParts& parts, const PanelOptions& options);

}  // namespace orchard::detail
