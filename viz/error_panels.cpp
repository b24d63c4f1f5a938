#include "error_panels.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace orchard::detail {
namespace {

// The places of one measure with their numbers, and the largest value among them, in % as in the arrays.
struct Worst {
  std::vector<Label> labels;
  std::string span;
  double max = 0;
};

Worst worst_of(vtkPolyData* places, int measure) {
  Worst worst;
  if (places == nullptr) return worst;
  vtkPointData* arrays = places->GetPointData();
  const vtkIdType count = places->GetNumberOfPoints();
  vtkDataArray* measures = require_array(arrays, "measure", count);
  vtkDataArray* numbers = require_array(arrays, "number", count);
  vtkDataArray* values = require_array(arrays, "value", count);
  vtkDataArray* outward = require_array(arrays, "outward", count);
  for (vtkIdType i = 0; i < count; ++i) {
    if (static_cast<int>(measures->GetComponent(i, 0)) != measure) continue;
    worst.max = std::max(worst.max, values->GetComponent(i, 0));
    Label& label = worst.labels.emplace_back();
    places->GetPoint(i, label.position.data());
    outward->GetTuple(i, label.outward.data());
    label.text = std::to_string(static_cast<int>(numbers->GetComponent(i, 0)));
  }
  if (!worst.labels.empty()) worst.span = "; worst: " + worst.labels.front().text + " to " + worst.labels.back().text;
  return worst;
}

// Writes the text below a panel's caption, and adds its labels. `max` is the largest of the values that are drawn,
// which may be elsewhere than at the worst places.
void describe(Panel& panel, Worst worst, double max) {
  constexpr double kNothing = 5e-5;  // in %: smaller values are rounding errors
  max = std::max(max, worst.max);
  if (max < kNothing) {
    panel.detail = "none above 0.0001 % of the diagonal";
    return;
  }
  char text[64];
  std::snprintf(text, sizeof text, "0 to %.3g %% of the diagonal", max);
  panel.detail = text + worst.span;
  panel.labels = std::move(worst.labels);
}

// A dent is a place of the reconstruction below the surface, so it is numbered in the panel that shows the surface.
void add_dents(Panel& panel, const Worst& dents) {
  for (const Label& label : dents.labels) {
    panel.detail += "; deepest dent: " + label.text;
    panel.labels.push_back(label);
  }
}

// An axis and the places where it is worst.
struct JudgedAxis {
  std::string name;  // empty if there is only one axis
  Data points, medial, places;

  double max_coverage() const { return max_of(points, "coverage"); }
  double max_protrusion() const { return max_of(medial, "protrusion"); }

 private:
  static double max_of(vtkPolyData* data, const char* name) {
    return require_array(data->GetPointData(), name, data->GetNumberOfPoints())->GetRange()[1];
  }
};

std::string captioned(const JudgedAxis& axis, const char* caption) {
  return axis.name.empty() ? caption : axis.name + ": " + caption;
}

// The colours have the range up to `max`, which is the largest value of all axes.
Panel coverage_panel(vtkPolyData* mesh, const JudgedAxis& axis, double max, double size, double line_width) {
  Panel panel{make_renderer(size), captioned(axis, "surface left uncovered"), {}};
  const vtkIdType count = axis.points->GetNumberOfPoints();
  vtkDataArray* coverage = require_array(axis.points->GetPointData(), "coverage", count);
  const auto colors = error_colors(max);
  vtkNew<vtkPolyData> dots;
  dots->SetPoints(axis.points->GetPoints());
  set_colors(dots->GetPointData(), count, [&](vtkIdType i) {
    Color color{};
    colors->GetColor(coverage->GetComponent(i, 0), color.data());
    return color;
  });
  vtkNew<vtkDoubleArray> radii;
  radii->SetName("radius");
  radii->SetNumberOfValues(count);
  radii->Fill(std::clamp(1.1 * size / std::sqrt(static_cast<double>(count)), 0.006 * size, 0.03 * size));
  dots->GetPointData()->AddArray(radii);
  panel.renderer->AddActor(make_actor(mesh, {0.93, 0.94, 0.95}));
  panel.renderer->AddActor(make_spheres(dots));
  panel.renderer->AddActor(edges(mesh, kFeatureAngle, line_width, 0.6));
  describe(panel, worst_of(axis.places, 1), axis.max_coverage());
  add_dents(panel, worst_of(axis.places, 2));
  return panel;
}

Panel protrusion_panel(vtkPolyData* mesh, const JudgedAxis& axis, double max, double size, double line_width) {
  Panel panel{make_renderer(size), captioned(axis, "balls that protrude"), {}};
  auto sheet = make_sheet(axis.medial, "protrusion", error_colors(max));
  sheet->GetProperty()->SetLineWidth(static_cast<float>(2 * line_width));
  panel.renderer->AddActor(sheet);
  add_glass(panel.renderer, mesh, line_width);
  describe(panel, worst_of(axis.places, 0), axis.max_protrusion());
  return panel;
}

// Returns the first axis, and those in the blocks "medial mesh 2: NAME" and so on.
std::vector<JudgedAxis> axes_of(const Blocks& blocks) {
  std::vector<JudgedAxis> axes{{"", blocks["surface points"], blocks["medial mesh"], blocks["worst places"]}};
  for (const auto& [block, data] : blocks.all()) {
    const std::string number = std::to_string(axes.size() + 1), begin = "medial mesh " + number + ": ";
    if (!block.starts_with(begin)) continue;
    axes.push_back({block.substr(begin.size()), blocks["surface points " + number], vtkPolyData::SafeDownCast(data),
                    blocks["worst places " + number]});
    if (axes.back().points == nullptr) throw std::runtime_error("a scene has no block 'surface points " + number + "'");
  }
  if (axes.size() > 1) axes.front().name = "this axis";
  return axes;
}

}  // namespace

Panels error_panels(const Blocks& blocks, double line_width) {
  Panels result;
  const Data mesh = blocks["mesh"];
  const std::vector<JudgedAxis> axes = axes_of(blocks);
  extend(result.extents, mesh, nullptr);
  result.size = 0.5 * mesh->GetLength();
  result.columns = 4;
  double coverage = 0, protrusion = 0;
  for (const JudgedAxis& axis : axes) {
    coverage = std::max(coverage, axis.max_coverage());
    protrusion = std::max(protrusion, axis.max_protrusion());
  }
  for (const JudgedAxis& axis : axes) {
    for (const bool from_behind : {false, true}) {
      result.panels.push_back(coverage_panel(mesh, axis, coverage, result.size, line_width));
      result.panels.push_back(protrusion_panel(mesh, axis, protrusion, result.size, line_width));
      for (std::size_t i = result.panels.size() - 2; from_behind && i < result.panels.size(); ++i) {
        result.panels[i].from_behind = true;
        result.panels[i].caption += ", from behind";
      }
    }
  }
  return result;
}

}  // namespace orchard::detail
