#include "view_parts.h"

#include <vtkCellData.h>
#include <vtkFeatureEdges.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "cell_actors.h"
#include "coloring.h"

namespace orchard::detail {
namespace {

// Parses "view/KIND/NAME" or "view/level/K/NAME". Sets `rest` to what follows the kind if it is `kind`.
bool named_as(const std::string& block, const std::string& kind, std::string& rest) {
  const std::string begin = "view/" + kind + "/";
  if (!block.starts_with(begin)) return false;
  rest = block.substr(begin.size());
  return true;
}

vtkSmartPointer<vtkActor> make_axis(vtkPolyData* axis, const PartLook& look) {
  if (look.coloring != nullptr && has_colors(*look.coloring, axis)) {
    auto sheet = make_actor(axis, kStone);
    apply(*look.coloring, axis, sheet);
    sheet->GetProperty()->SetLineWidth(static_cast<float>(1.5 * look.line_width));
    return sheet;
  }
  require_array(axis->GetPointData(), "radius", axis->GetNumberOfPoints());
  auto sheet = make_sheet(axis, "radius", transfer_function(*look.map, look.radii.data()));
  sheet->GetProperty()->SetLineWidth(static_cast<float>(1.5 * look.line_width));
  return sheet;
}

// Draws edges of one triangle (borders), or those of three or more (seams).
vtkSmartPointer<vtkActor> axis_lines(vtkPolyData* axis, bool seams, const Color& color, double width) {
  vtkNew<vtkFeatureEdges> filter;
  filter->SetInputData(axis);
  filter->SetBoundaryEdges(!seams);
  filter->SetNonManifoldEdges(seams);
  filter->FeatureEdgesOff();
  filter->ManifoldEdgesOff();
  filter->ColoringOff();
  filter->Update();
  auto actor = make_actor(filter->GetOutput(), color);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  return actor;
}

void add_axis(vtkRenderer* renderer, vtkPolyData* axis, const PartLook& look) {
  if (!look.balls) renderer->AddActor(make_axis(axis, look));
  if (look.balls) {
    const Coloring* coloring = look.coloring;
    if (coloring != nullptr && has_colors(*coloring, axis)) {
      color_points(*coloring, axis);
    } else {
      set_colors(axis->GetPointData(), axis->GetNumberOfPoints(), [](vtkIdType) { return kStone; });
    }
    renderer->AddActor(make_spheres(axis));
  }
  if (!look.edges) return;
  renderer->AddActor(axis_lines(axis, false, kBorderColor, 1.5 * look.line_width));
  renderer->AddActor(axis_lines(axis, true, look.map->seams, 2 * look.line_width));
}

// Adds any .vtp file: its faces and lines, or, if it has only points, spheres of their radii or dots.
void add_data(vtkRenderer* renderer, vtkPolyData* data, const PartLook& look) {
  const bool colored = look.coloring != nullptr && has_colors(*look.coloring, data);
  if (is_point_set(data)) {
    vtkNew<vtkPolyData> dots;
    dots->ShallowCopy(data);
    if (colored) {
      color_points(*look.coloring, dots);
    } else {
      set_colors(dots->GetPointData(), dots->GetNumberOfPoints(), [](vtkIdType) { return kOriginColors[0]; });
    }
    renderer->AddActor(is_sphere_set(data) ? make_spheres(dots) : make_dots(dots, look.size));
    return;
  }
  const bool bound = is_bound(data);
  auto actor = make_actor(data, bound ? kGlass : kStone, bound ? look.opacity : 1);
  if (colored) apply(*look.coloring, data, actor);
  actor->GetProperty()->SetLineWidth(static_cast<float>(1.5 * look.line_width));
  renderer->AddActor(actor);
  if (bound) renderer->AddActor(edges(data, kFeatureAngle, 0.8 * look.line_width, 0.5));
  if (look.edges) renderer->AddActor(edges(data, kFeatureAngle, 1.2 * look.line_width));
}

vtkSmartPointer<vtkActor> make_points(vtkPolyData* points, double size) {
  vtkNew<vtkPolyData> dots;
  dots->SetPoints(points->GetPoints());
  set_colors(dots->GetPointData(), points->GetNumberOfPoints(), [](vtkIdType) { return kOriginColors[0]; });
  return make_dots(dots, size);
}

vtkSmartPointer<vtkActor> in_one_color(vtkPolyData* spheres, const Color& color) {
  set_colors(spheres->GetPointData(), spheres->GetNumberOfPoints(), [&](vtkIdType) { return color; });
  return make_spheres(spheres);
}

// Returns how far the spheres of a level protrude at most, if the file has that.
std::string reach(vtkPolyData* spheres) {
  vtkDataArray* errors = require_array(spheres->GetPointData(), "error", spheres->GetNumberOfPoints());
  double max = 0;
  for (vtkIdType i = 0; i < errors->GetNumberOfTuples(); ++i) {
    const double error = errors->GetComponent(i, 0);
    if (!std::isfinite(error)) return {};  // it is not known for this one
    max = std::max(max, error);
  }
  if (max <= 0) return {};
  char text[64];
  std::snprintf(text, sizeof text, ", at most %.3g outside", max);
  return text;
}

void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

// A grid of polyhedra is a Voronoi diagram.
void add_data_block(const std::string& name, vtkDataObject* data, ViewParts& parts) {
  if (vtkPolyData* poly = vtkPolyData::SafeDownCast(data)) parts.data.emplace_back(name, poly);
  vtkUnstructuredGrid* grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (grid == nullptr || grid->GetNumberOfCells() == 0) return;
  if (grid->GetCellType(0) == VTK_POLYHEDRON)
    parts.cells.emplace_back(name, grid);
  else
    parts.data.emplace_back(name, as_poly_data(grid));
}

}  // namespace

ViewParts view_parts(const Blocks& blocks) {
  ViewParts parts;
  std::string name;
  for (const auto& [block, data] : blocks.all()) {
    const Data poly = vtkPolyData::SafeDownCast(data);
    if (named_as(block, "mesh", name) && poly != nullptr) parts.meshes.emplace_back(name, poly);
    if (named_as(block, "axis", name) && poly != nullptr) parts.axes.emplace_back(name, poly);
    if (named_as(block, "data", name)) add_data_block(name, data, parts);
    if (named_as(block, "points", name) && poly != nullptr) parts.points.emplace_back(name, poly);
    if (named_as(block, "cells", name) && vtkUnstructuredGrid::SafeDownCast(data) != nullptr)
      parts.cells.emplace_back(name, vtkUnstructuredGrid::SafeDownCast(data));
    if (named_as(block, "level", name) && poly != nullptr)
      parts.levels[std::atoi(name.c_str())].emplace_back(name.substr(name.find('/') + 1), poly);
  }
  return parts;
}

std::vector<Extent> extents_of(const ViewParts& parts) {
  std::vector<Extent> extents;
  for (const auto* list : {&parts.meshes, &parts.axes, &parts.points, &parts.data})
    for (const auto& part : *list) extend(extents, part.second, is_sphere_set(part.second) ? "radius" : nullptr);
  for (const auto& [level, trees] : parts.levels)
    for (const auto& part : trees) extend(extents, part.second, "radius");
  for (const auto& part : parts.cells) {
    for (vtkIdType i = 0; i < part.second->GetNumberOfPoints(); ++i) {
      Extent extent{{}, 0};
      part.second->GetPoint(i, extent.center.data());
      extents.push_back(extent);
    }
  }
  return extents;
}

std::vector<Extent> extents_of(const ViewParts& parts, const FigureOptions& figure) {
  std::vector<Extent> extents = extents_of(parts);
  if (figure.balls)
    for (const auto& part : parts.axes) extend(extents, part.second, "radius");
  if (figure.room) {
    const auto& [a, b, c, d, e, f] = *figure.room;
    extents.push_back({{a, b, c}, 0});
    extents.push_back({{d, e, f}, 0});
  }
  return extents;
}

bool is_point_set(vtkPolyData* data) {
  return data->GetNumberOfPolys() + data->GetNumberOfLines() + data->GetNumberOfStrips() == 0;
}

bool is_sphere_set(vtkPolyData* data) {
  vtkDataArray* radii = data->GetPointData()->GetArray("radius");
  return is_point_set(data) && radii != nullptr && radii->GetNumberOfComponents() == 1;
}

bool is_bound(vtkPolyData* data) { return data->GetPointData()->HasArray("hypertrapezoid_half") != 0; }

std::array<double, 2> radii_of_axes(const ViewParts& parts) {
  std::array<double, 2> range{std::numeric_limits<double>::infinity(), 0};
  for (const auto& part : parts.axes) {
    const double* own =
        require_array(part.second->GetPointData(), "radius", part.second->GetNumberOfPoints())->GetRange();
    range = {std::min(range[0], own[0]), std::max(range[1], own[1])};
  }
  return range[0] < range[1] ? range : std::array{0.0, std::max(range[1], 1e-300)};
}

double size_of(const ViewParts& parts) {
  Eigen::AlignedBox3d box;
  for (const Extent& extent : extents_of(parts)) box.extend(Eigen::Vector3d(extent.center.data()));
  const double size = box.isEmpty() ? 0 : 0.5 * box.diagonal().norm();
  if (size > 0) return size;
  // The box of the centres is a single point if there is one sphere, so its radius is used.
  for (const auto& [level, trees] : parts.levels)
    return trees.front().second->GetPointData()->GetArray("radius")->GetRange()[1];
  return 1;
}

std::vector<vtkSmartPointer<vtkActor>> add_still_parts(vtkRenderer* renderer, const ViewParts& parts,
                                                       const PartLook& look) {
  for (const auto& part : parts.points) renderer->AddActor(make_points(part.second, look.size));
  for (const auto& part : parts.axes) add_axis(renderer, part.second, look);
  for (const auto& part : parts.data) add_data(renderer, part.second, look);
  for (const auto& part : parts.cells) renderer->AddActor(make_cells(part.second, look.backward, look.line_width));
  std::vector<vtkSmartPointer<vtkActor>> glass;
  for (const auto& part : parts.meshes) {
    if (parts.meshes_alone()) {
      add_mesh(renderer, part.second, look.line_width);
    } else {
      glass.push_back(add_glass(renderer, part.second, look.line_width, look.opacity));
    }
  }
  return glass;
}

std::vector<vtkSmartPointer<vtkActor>> level_actors(const NamedParts<Data>& trees, const Coloring* coloring) {
  std::vector<vtkSmartPointer<vtkActor>> actors;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const Data& spheres = trees[i].second;
    if (coloring != nullptr && has_colors(*coloring, spheres)) {
      color_points(*coloring, spheres);
      actors.push_back(make_spheres(spheres));
    } else {
      actors.push_back(trees.size() == 1 ? make_level(spheres)
                                         : in_one_color(spheres, kBranchColors.at(i % kBranchColors.size())));
    }
  }
  return actors;
}

std::string caption_of(const ViewParts& parts, int level) {
  std::string caption;
  for (const auto* list : {&parts.meshes, &parts.axes, &parts.points, &parts.data})
    for (const auto& part : *list) append(caption, part.first);
  for (const auto& part : parts.cells) append(caption, part.first);
  if (const auto trees = parts.levels.find(level); trees != parts.levels.end()) {
    for (const auto& part : trees->second) append(caption, part.first);
    caption += ", level " + std::to_string(level);
  }
  return caption;
}

std::string detail_of(const ViewParts& parts, int level) {
  std::string detail;
  for (const auto& part : parts.meshes) append(detail, counted(part.second->GetNumberOfPolys(), "triangle"));
  for (const auto& part : parts.axes) append(detail, counted(part.second->GetNumberOfPoints(), "medial sphere"));
  for (const auto* list : {&parts.points, &parts.data})
    for (const auto& part : *list) append(detail, counted(part.second->GetNumberOfPoints(), "point"));
  for (const auto& part : parts.cells) {
    append(detail, counted(part.second->GetNumberOfCells(), "cell"));
    if (!is_inaccurate(part.second)) continue;
    char text[64];
    const double max = part.second->GetCellData()->GetArray("inaccuracy")->GetRange()[1];
    std::snprintf(text, sizeof text, "red: inaccurate by %.2g", max);
    append(detail, text);
  }
  if (const auto trees = parts.levels.find(level); trees != parts.levels.end())
    for (const auto& part : trees->second)
      append(detail, counted(part.second->GetNumberOfPoints(), "sphere") + reach(part.second));
  return detail;
}

}  // namespace orchard::detail
