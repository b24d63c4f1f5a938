#include "panels.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>

#include "actors.h"
#include "blocks.h"
#include "error_panels.h"
#include "sheet_border.h"
#include "view_panels.h"

namespace orchard::detail {
namespace {

constexpr double kMinAngle = 52;  // degrees
constexpr int kLevelsShown = 3;

Panel mesh_panel(vtkPolyData* mesh, double size, double line_width) {
  Panel panel{make_renderer(size), "mesh", counted(mesh->GetNumberOfPolys(), "triangle")};
  add_mesh(panel.renderer, mesh, line_width);
  return panel;
}

Panel points_panel(vtkPolyData* mesh, vtkPolyData* points, double size) {
  Panel panel{make_renderer(size), "surface points", {}};
  vtkDataArray* origins = require_array(points->GetPointData(), "origin", points->GetNumberOfPoints());
  std::array<vtkIdType, 3> counts{};
  const auto origin_of = [&](vtkIdType i) { return std::clamp(static_cast<int>(origins->GetComponent(i, 0)), 0, 2); };
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) ++counts.at(static_cast<std::size_t>(origin_of(i)));
  panel.detail = grouped(counts[0]) + " on faces, " + grouped(counts[1]) + " on edges";
  if (counts[2] > 0) panel.detail += ", " + grouped(counts[2]) + " by repair";

  vtkNew<vtkPolyData> dots;
  dots->SetPoints(points->GetPoints());
  set_colors(dots->GetPointData(), points->GetNumberOfPoints(),
             [&](vtkIdType i) { return kOriginColors.at(static_cast<std::size_t>(origin_of(i))); });
  if (mesh != nullptr) panel.renderer->AddActor(make_actor(mesh, {0.93, 0.94, 0.95}));
  panel.renderer->AddActor(make_dots(dots, size));
  return panel;
}

Panel axis_panel(vtkPolyData* mesh, vtkPolyData* faces, double size, double line_width) {
  Panel panel{make_renderer(size), "medial axis", counted(faces->GetNumberOfPoints(), "sphere") + ", colour: radius"};
  double range[2];
  require_array(faces->GetPointData(), "radius", faces->GetNumberOfPoints())->GetRange(range);
  panel.renderer->AddActor(make_sheet(drawn_sheets(faces, kMinAngle), "radius", transfer_function(kViridis, range)));
  if (mesh != nullptr) add_glass(panel.renderer, mesh, line_width);
  return panel;
}

Panel spheres_panel(const std::string& title, vtkPolyData* spheres, double size, double bounding_radius) {
  Panel panel{make_renderer(size), title, level_figures(spheres, bounding_radius)};
  panel.renderer->AddActor(make_level(spheres));
  return panel;
}

}  // namespace

Panels make_panels(const std::filesystem::path& vtm, const PanelOptions& options) {
  const double line_width = options.line_width;
  Panels result;
  const Blocks blocks(vtm);
  if (const ViewParts parts = view_parts(blocks); parts.any()) return view_panels(parts, options);
  const Data mesh = blocks["mesh"], points = blocks["surface points"], faces = blocks["medial faces"];
  if (blocks["medial mesh"] != nullptr && mesh != nullptr && points != nullptr) return error_panels(blocks, line_width);
  std::vector<Data> levels;  // beginning at the root
  for (;;) {
    const Data level = blocks["tree level " + std::to_string(levels.size())];
    if (level == nullptr) break;
    levels.push_back(level);
  }
  const int last = static_cast<int>(levels.size()) - 1;
  const int first = std::min(last, 1);

  double bounding_radius = 0;
  if (mesh != nullptr) {
    extend(result.extents, mesh, nullptr);
    result.size = 0.5 * mesh->GetLength();
    vtkDataArray* radius = mesh->GetFieldData()->GetArray("bounding_radius");
    if (radius != nullptr) bounding_radius = radius->GetComponent(0, 0);
    result.panels.push_back(mesh_panel(mesh, result.size, line_width));
  } else if (last >= 0) {
    result.size = 0.5 * levels.back()->GetLength();
  }
  if (points != nullptr) result.panels.push_back(points_panel(mesh, points, result.size));
  if (faces != nullptr) result.panels.push_back(axis_panel(mesh, faces, result.size, line_width));
  for (int level = std::max(first, 0); level <= std::min(last, kLevelsShown); ++level) {
    extend(result.extents, levels[static_cast<std::size_t>(level)], "radius");
    result.panels.push_back(spheres_panel("sphere-tree, level " + std::to_string(level),
                                          levels[static_cast<std::size_t>(level)], result.size, bounding_radius));
  }
  if (const Data spheres = blocks["spheres"]; spheres != nullptr) {
    extend(result.extents, spheres, "radius");
    if (mesh == nullptr && levels.empty()) result.size = 0.5 * spheres->GetLength();
    result.panels.push_back(spheres_panel("spheres", spheres, result.size, bounding_radius));
  }
  return result;
}

}  // namespace orchard::detail
