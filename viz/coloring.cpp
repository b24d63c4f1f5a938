#include "coloring.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <stdexcept>

#include "screen_shapes.h"

namespace orchard::detail {
namespace {

constexpr Color kUndefined = rgb(0xb8b8b8);  // for values that are not defined
const std::set<std::string> kCategories{
    "answer", "body",      "branch",         "carried", "cluster",       "component", "kind",  "measure",
    "node",   "origin",    "parent",         "segment", "part",          "region",    "curve", "thin_region",
    "sheet",  "structure", "structure_kind", "trunk",   "topology_face", "has_faces"};

std::vector<vtkPolyData*> all_of(const ViewParts& parts) {
  std::vector<vtkPolyData*> all;
  for (const auto* list : {&parts.meshes, &parts.axes, &parts.points, &parts.data})
    for (const auto& part : *list) all.push_back(part.second);
  for (const auto& [level, trees] : parts.levels)
    for (const auto& part : trees) all.push_back(part.second);
  return all;
}

vtkDataArray* array_in(vtkDataSetAttributes* data, const std::string& name) {
  vtkDataArray* array = data->GetArray(name.c_str());
  return array != nullptr && array->GetNumberOfComponents() == 1 ? array : nullptr;
}

// Whether the colours are those of cells. Numbers of parts belong to cells rather than to the points between them.
bool of_cells(const Coloring& coloring, vtkPolyData* data) {
  const bool cells = array_in(data->GetCellData(), coloring.array) != nullptr;
  return cells && (coloring.categories || array_in(data->GetPointData(), coloring.array) == nullptr);
}

vtkDataSetAttributes* attributes_of(const Coloring& coloring, vtkPolyData* data) {
  if (of_cells(coloring, data)) return data->GetCellData();
  return data->GetPointData();
}

void add_range(vtkDataArray* values, std::array<double, 2>& range) {
  for (vtkIdType i = 0; values != nullptr && i < values->GetNumberOfTuples(); ++i) {
    const double value = values->GetComponent(i, 0);
    if (std::isfinite(value)) range = {std::min(range[0], value), std::max(range[1], value)};
  }
}

void add_names(vtkDataSetAttributes* data, std::set<std::string>& names) {
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (const char* name = data->GetArrayName(i); name != nullptr && array_in(data, name) != nullptr)
      names.insert(name);
}

[[noreturn]] void fail_without(const std::string& array, const ViewParts& parts) {
  std::set<std::string> names;
  for (vtkPolyData* data : all_of(parts)) add_names(data->GetPointData(), names), add_names(data->GetCellData(), names);
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  throw std::runtime_error("no file has an array '" + array + "' to colour by; they have " +
                           (list.empty() ? "none" : list));
}

void add_print(vtkRenderer* renderer, const std::string& text, double x, double y, int pixels, bool upright) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(pixels);
  property->SetColor(kInk[0], kInk[1], kInk[2]);
  property->SetVerticalJustificationToCentered();
  if (upright) property->SetJustificationToCentered();
  if (upright) property->SetOrientation(90);
  actor->SetPosition(x, y);
  renderer->AddViewProp(actor);
}

// Adds a short line on the right of the bar.
void add_mark(vtkRenderer* renderer, double left, double right, double y, double width) {
  add_screen_line(renderer, {left, y}, {right, y}, kInk, width);
}

// Makes a bar of rectangles one above the other.
vtkSmartPointer<vtkPolyData> bar(const Coloring& coloring, double left, double right, double low, double high) {
  constexpr int kSteps = 128;
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> quads;
  for (int i = 0; i <= kSteps; ++i) {
    const double y = low + (high - low) * i / kSteps;
    points->InsertNextPoint(left, y, 0);
    points->InsertNextPoint(right, y, 0);
    if (i == kSteps) break;
    const vtkIdType first = vtkIdType{2} * i;
    const std::array<vtkIdType, 4> corners{first, first + 1, first + 3, first + 2};
    quads->InsertNextCell(4, corners.data());
  }
  data->SetPoints(points);
  data->SetPolys(quads);
  set_colors(data->GetCellData(), kSteps, [&](vtkIdType i) {
    const double t = (static_cast<double>(i) + 0.5) / kSteps;
    return coloring.color_of(coloring.range[0] + t * (coloring.range[1] - coloring.range[0]));
  });
  return data;
}

}  // namespace

Color Coloring::color_of(double value) const {
  if (!std::isfinite(value)) return kUndefined;
  if (categories) {
    if (value < 0) return kUndefined;
    return kDistinct.at(static_cast<std::size_t>(value) % kDistinct.size());
  }
  Color color{};
  colors->GetColor(value, color.data());
  return color;
}

std::optional<Coloring> coloring_of(const ViewParts& parts, const FigureOptions& figure) {
  if (figure.color.empty()) return std::nullopt;
  Coloring coloring{.array = figure.color,
                    .title = figure.bar_title.empty() ? figure.color : figure.bar_title,
                    .categories = kCategories.contains(figure.color),
                    .colors = {}};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 2> range{kInfinity, -kInfinity};
  bool found = false;
  for (vtkPolyData* data : all_of(parts)) {
    if (!has_colors(coloring, data)) continue;
    found = true;
    add_range(attributes_of(coloring, data)->GetArray(coloring.array.c_str()), range);
  }
  if (!found) fail_without(figure.color, parts);
  if (range[0] > range[1]) range = {0, 1};  // no value is defined
  if (figure.range) range = *figure.range;
  if (range[0] == range[1]) range[1] = range[0] + std::max(1e-9, 1e-9 * std::abs(range[0]));
  coloring.range = range;
  coloring.colors = transfer_function(*color_map(figure.map), range.data());
  coloring.colors->SetNanColor(kUndefined[0], kUndefined[1], kUndefined[2]);
  return coloring;
}

bool has_colors(const Coloring& coloring, vtkPolyData* data) {
  return array_in(data->GetPointData(), coloring.array) != nullptr ||
         array_in(data->GetCellData(), coloring.array) != nullptr;
}

void apply(const Coloring& coloring, vtkPolyData* data, vtkActor* actor) {
  vtkMapper* mapper = actor->GetMapper();
  vtkDataSetAttributes* attributes = attributes_of(coloring, data);
  vtkDataArray* values = attributes->GetArray(coloring.array.c_str());
  mapper->ScalarVisibilityOn();
  if (of_cells(coloring, data)) {
    mapper->SetScalarModeToUseCellFieldData();
  } else {
    mapper->SetScalarModeToUsePointFieldData();
  }
  if (coloring.categories) {
    set_colors(attributes, values->GetNumberOfTuples(),
               [&](vtkIdType i) { return coloring.color_of(values->GetComponent(i, 0)); });
    mapper->SelectColorArray("color");
    mapper->SetColorModeToDirectScalars();
    mapper->InterpolateScalarsBeforeMappingOff();
  } else {
    mapper->SelectColorArray(coloring.array.c_str());
    mapper->SetLookupTable(coloring.colors);
    mapper->UseLookupTableScalarRangeOn();
    mapper->InterpolateScalarsBeforeMappingOn();
  }
  // Light should hardly change colours that represent values.
  actor->GetProperty()->SetAmbient(0.35);
  actor->GetProperty()->SetDiffuse(0.65);
  actor->GetProperty()->SetSpecular(0);
}

void color_points(const Coloring& coloring, vtkPolyData* data) {
  vtkDataArray* values = array_in(data->GetPointData(), coloring.array);
  set_colors(data->GetPointData(), data->GetNumberOfPoints(), [&](vtkIdType i) {
    return values == nullptr ? kUndefined : coloring.color_of(values->GetComponent(i, 0));
  });
}

std::vector<double> round_numbers(double low, double high) {
  const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.5, 2.0, 1.0})
    if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
  std::vector<double> numbers;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) numbers.push_back(i * step + 0.0);
  return numbers;
}

vtkSmartPointer<vtkRenderer> color_bar(const Coloring& coloring, int width, int height) {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(1, 1, 1);
  const double low = 0.15 * height, high = 0.85 * height, left = 0.30 * width, right = 0.46 * width;
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(bar(coloring, left, right, low, high));
  mapper->SetScalarModeToUseCellFieldData();
  mapper->ColorByArrayComponent("color", 0);
  mapper->SetColorModeToDirectScalars();
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  renderer->AddViewProp(actor);
  const int print = std::max(8, std::min(width / 7, height / 18));
  const auto [from, to] = coloring.range;
  for (const double number : round_numbers(from, to)) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", number);
    const double place = low + (number - from) / (to - from) * (high - low);
    add_mark(renderer, right, right + 0.06 * width, place, std::max(1.0, print / 14.0));
    add_print(renderer, text, right + 0.09 * width, place, print, false);
  }
  constexpr double kLetter = 0.5;  // the width of a letter over the size of the print
  const double room = 0.98 * height / (kLetter * static_cast<double>(std::max<std::size_t>(coloring.title.size(), 1)));
  add_print(renderer, coloring.title, 0.16 * width, 0.5 * (low + high), std::min(print, static_cast<int>(room)), true);
  return renderer;
}

}  // namespace orchard::detail
