#pragma once
#include "panels.h"
#include "view_parts.h"

namespace orchard::detail {

// The contents of one panel.
struct PanelParts {
  ViewParts parts;
  int level = -1;  // the level of its trees; -1 if there are none
};
// Divides the parts of a view among panels. Each level of the trees gets a panel, or there is one panel if there are no
// trees. If there are several Voronoi diagrams, there are such panels for each of them, because they would hide each
// other. Everything else is in all panels. With figure.beside, each part has its own panels instead, together with the
// meshes.
std::vector<PanelParts> panel_parts(const ViewParts& parts, const FigureOptions& figure);

// Makes the panels of panel_parts().
Panels view_panels(const ViewParts& parts, const PanelOptions& options);

}  // namespace orchard::detail
