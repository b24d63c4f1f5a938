#include "view_panels.h"

namespace orchard::detail {

namespace {

// Two diagrams of the same points hide each other: a panel for each.
std::vector<ViewParts> one_diagram_each(const ViewParts& parts) {
  if (parts.cells.size() < 2) return {parts};
  std::vector<ViewParts> all;
  for (const auto& diagram : parts.cells) {
    ViewParts& one = all.emplace_back(parts);
    one.cells = {diagram};
  }
  return all;
}

}  // namespace

Panels view_panels(const ViewParts& parts, const PanelOptions& options) {
  Panels result;
  result.extents = extents_of(parts);
  result.size = size_of(parts);
  const auto add = [&](const ViewParts& seen, int level) -> vtkRenderer* {
    Panel& panel =
        result.panels.emplace_back(Panel{make_renderer(result.size), caption_of(seen, level), detail_of(seen, level)});
    add_still_parts(panel.renderer, seen, result.size, options.line_width, options.opacity,
                    options.whole ? std::nullopt : std::optional(options.backward));
    return panel.renderer;
  };
  for (const ViewParts& seen : one_diagram_each(parts)) {
    for (const auto& [level, trees] : seen.levels) {
      vtkRenderer* renderer = add(seen, level);
      for (const auto& actor : level_actors(trees)) renderer->AddActor(actor);
    }
    if (seen.levels.empty()) add(seen, -1);
  }
  return result;
}

}  // namespace orchard::detail
