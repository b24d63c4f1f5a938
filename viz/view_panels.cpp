#include "view_panels.h"

#include <vtkActorCollection.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkPlane.h>

#include "coloring.h"

namespace orchard::detail {

namespace {

// Returns each thing together with the meshes around it.
std::vector<ViewParts> beside(const ViewParts& parts) {
  std::vector<ViewParts> all;
  const auto add = [&](auto member, const auto& thing) {
    ViewParts& one = all.emplace_back();
    one.meshes = parts.meshes;
    one.*member = {thing};
  };
  for (const auto& part : parts.points) add(&ViewParts::points, part);
  for (const auto& part : parts.axes) add(&ViewParts::axes, part);
  for (const auto& part : parts.data) add(&ViewParts::data, part);
  for (const auto& part : parts.cells) add(&ViewParts::cells, part);
  for (const auto& [level, trees] : parts.levels) {
    for (const auto& part : trees) {
      ViewParts& one = all.emplace_back();
      one.meshes = parts.meshes;
      one.levels[level] = {part};
    }
  }
  if (!all.empty()) return all;
  for (const auto& part : parts.meshes) all.emplace_back().meshes = {part};
  return all;
}

// Two diagrams of the same points would hide each other, so each gets a panel.
std::vector<ViewParts> one_diagram_each(const ViewParts& parts) {
  if (parts.cells.size() < 2) return {parts};
  std::vector<ViewParts> all;
  for (const auto& diagram : parts.cells) {
    ViewParts& one = all.emplace_back(parts);
    one.cells = {diagram};
  }
  return all;
}

// Cuts away the part with a x + b y + c z > d.
void clip(vtkRenderer* renderer, const std::array<double, 4>& plane) {
  const auto& [a, b, c, d] = plane;
  const double square = a * a + b * b + c * c;
  vtkNew<vtkPlane> cut;
  cut->SetOrigin(a * d / square, b * d / square, c * d / square);
  cut->SetNormal(-a, -b, -c);
  vtkActorCollection* actors = renderer->GetActors();
  actors->InitTraversal();
  while (vtkActor* actor = actors->GetNextActor()) actor->GetMapper()->AddClippingPlane(cut);
}

}  // namespace

std::vector<PanelParts> panel_parts(const ViewParts& parts, const FigureOptions& figure) {
  std::vector<PanelParts> all;
  for (const ViewParts& seen : figure.beside ? beside(parts) : one_diagram_each(parts)) {
    for (const auto& [level, trees] : seen.levels) all.push_back({seen, level});
    if (seen.levels.empty()) all.push_back({seen, -1});
  }
  return all;
}

Panels view_panels(const ViewParts& parts, const PanelOptions& options) {
  const FigureOptions& figure = options.figure;
  Panels result;
  result.extents = extents_of(parts, figure);
  result.size = size_of(parts);
  const std::optional<Coloring> coloring = coloring_of(parts, figure);
  if (coloring && !coloring->categories)
    result.color_bar = [bar = *coloring](int width, int height) { return color_bar(bar, width, height); };
  const PartLook look{.size = result.size,
                      .line_width = options.line_width,
                      .opacity = options.opacity,
                      .backward = options.whole ? std::nullopt : std::optional(options.backward),
                      .edges = figure.edges,
                      .balls = figure.balls,
                      .map = color_map(figure.map),
                      .radii = radii_of_axes(parts),
                      .coloring = coloring ? &*coloring : nullptr};
  for (const auto& [seen, level] : panel_parts(parts, figure)) {
    const Panel& panel =
        result.panels.emplace_back(Panel{make_renderer(result.size), caption_of(seen, level), detail_of(seen, level)});
    add_still_parts(panel.renderer, seen, look);
    if (level < 0) continue;
    for (const auto& actor : level_actors(seen.levels.at(level), look.coloring)) panel.renderer->AddActor(actor);
  }
  if (figure.clip)
    for (const Panel& panel : result.panels) clip(panel.renderer, *figure.clip);
  return result;
}

}  // namespace orchard::detail
