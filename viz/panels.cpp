// One function for each panel of the pipeline picture beside what they share, hence more than 300 lines.
#include "panels.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkColorTransferFunction.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFeatureEdges.h>
#include <vtkFieldData.h>
#include <vtkGlyph3DMapper.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkLightKit.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLMultiBlockDataReader.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace orchard::detail {
namespace {

using Color = std::array<double, 3>;
using Data = vtkSmartPointer<vtkPolyData>;

constexpr Color kInk{0.13, 0.16, 0.20};
constexpr Color kStone{0.73, 0.77, 0.82};
constexpr double kFeatureAngle = 40;             // degrees
constexpr double kMinAngle = 0.9;                // radians
constexpr vtkIdType kTrianglesOutlined = 20000;  // more would turn the mesh black
constexpr int kLevelsShown = 3;

constexpr Color rgb(int hex) { return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0}; }
// Neighbouring branches must differ, also in brightness.
constexpr std::array<Color, 8> kBranchColors{rgb(0x4e79a7), rgb(0xf2a13c), rgb(0x6aaa5a), rgb(0xe0605f),
                                             rgb(0x7cc0bb), rgb(0xf0d060), rgb(0xb083b0), rgb(0xe8a0b4)};
constexpr std::array<Color, 3> kOriginColors{rgb(0x2f6db3), rgb(0xe8871e), rgb(0xc8233c)};

// The blocks of a .vtm by their names, but for empty ones and those that are no PolyData.
class Blocks {
 public:
  explicit Blocks(const std::filesystem::path& vtm) {
    if (!std::filesystem::exists(vtm)) throw std::runtime_error("there is no file " + vtm.string());
    vtkNew<vtkXMLMultiBlockDataReader> reader;
    reader->SetFileName(vtm.c_str());
    reader->Update();
    auto* all = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
    for (unsigned i = 0; all != nullptr && i < all->GetNumberOfBlocks(); ++i) {
      auto* data = vtkPolyData::SafeDownCast(all->GetBlock(i));
      const char* name = all->HasMetaData(i) != 0 ? all->GetMetaData(i)->Get(vtkCompositeDataSet::NAME()) : nullptr;
      if (data != nullptr && name != nullptr && data->GetNumberOfPoints() > 0) blocks_.emplace(name, data);
    }
  }

  Data operator[](const std::string& name) const {
    const auto block = blocks_.find(name);
    return block == blocks_.end() ? nullptr : block->second;
  }

 private:
  std::map<std::string, Data> blocks_;
};

// Values one per point or cell; a file that lacks them is not one of ours.
vtkDataArray* require_array(vtkDataSetAttributes* data, const char* name, vtkIdType count) {
  vtkDataArray* array = data->GetArray(name);
  if (array == nullptr || array->GetNumberOfTuples() != count) {
    throw std::runtime_error(std::string("a file has no complete array '") + name + "'");
  }
  return array;
}

// 12345 as "12 345".
std::string grouped(vtkIdType number) {
  const std::string digits = std::to_string(number);
  std::string result;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) result += ' ';
    result += digits[i];
  }
  return result;
}

std::string counted(vtkIdType number, const std::string& thing) {
  return grouped(number) + " " + thing + (number == 1 ? "" : "s");
}

vtkSmartPointer<vtkActor> make_actor(vtkMapper* mapper, const Color& color, double opacity = 1) {
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(color[0], color[1], color[2]);
  property->SetOpacity(opacity);
  property->SetAmbient(0.12);
  property->SetDiffuse(0.88);
  property->SetSpecular(0.12);
  property->SetSpecularPower(25);
  return actor;
}

vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data, const Color& color, double opacity = 1) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  return make_actor(mapper, color, opacity);
}

// Boundary edges and those where the surface turns by more than `angle` degrees; 0: all.
vtkSmartPointer<vtkActor> edges(vtkPolyData* mesh, double angle, double width, double opacity = 1) {
  vtkNew<vtkFeatureEdges> filter;
  filter->SetInputData(mesh);
  filter->SetFeatureAngle(angle);
  filter->SetManifoldEdges(angle == 0);
  filter->ColoringOff();
  filter->Update();
  auto actor = make_actor(filter->GetOutput(), kInk, opacity);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  return actor;
}

// Colours per tuple of `data` from a function of the tuple's number.
template <typename ColorOf>
void set_colors(vtkDataSetAttributes* data, vtkIdType count, const ColorOf& color_of) {
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("color");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const Color color = color_of(i);
    for (int c = 0; c < 3; ++c) {
      colors->SetTypedComponent(i, c,
                                static_cast<unsigned char>(std::lround(255 * color[static_cast<std::size_t>(c)])));
    }
  }
  data->AddArray(colors);
}

// A sphere of its `radius` around each point, in the points' `color`. Fine enough to look round, within reason.
vtkSmartPointer<vtkActor> make_spheres(vtkPolyData* points) {
  constexpr double kTriangles = 1.5e6;
  const auto count = static_cast<double>(points->GetNumberOfPoints());
  const int resolution = std::clamp(static_cast<int>(std::sqrt(kTriangles / 4 / count)), 5, 64);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(1);
  sphere->SetThetaResolution(2 * resolution);
  sphere->SetPhiResolution(resolution);
  vtkNew<vtkGlyph3DMapper> mapper;
  mapper->SetInputData(points);
  mapper->SetSourceConnection(sphere->GetOutputPort());
  mapper->SetScaleArray("radius");
  mapper->SetScaleModeToScaleByMagnitude();
  mapper->OrientOff();
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("color");
  return make_actor(mapper, kStone);
}

vtkSmartPointer<vtkRenderer> make_renderer(double size) {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(1, 1, 1);
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.95);
  lights->SetKeyToFillRatio(2.2);
  lights->SetKeyToHeadRatio(2);
  lights->AddLightsToRenderer(renderer);
  renderer->UseSSAOOn();
  renderer->SetSSAORadius(0.25 * size);
  renderer->SetSSAOBias(0.01 * size);
  renderer->SetSSAOKernelSize(64);
  renderer->SSAOBlurOn();
  return renderer;
}

Panel mesh_panel(vtkPolyData* mesh, double size, double line_width) {
  Panel panel{make_renderer(size), "mesh", counted(mesh->GetNumberOfPolys(), "triangle")};
  auto faces = make_actor(mesh, kStone);
  faces->GetProperty()->SetInterpolationToFlat();
  panel.renderer->AddActor(faces);
  panel.renderer->AddActor(edges(mesh, kFeatureAngle, 1.2 * line_width));
  if (mesh->GetNumberOfPolys() <= kTrianglesOutlined) panel.renderer->AddActor(edges(mesh, 0, 0.5 * line_width, 0.35));
  return panel;
}

Panel points_panel(vtkPolyData* mesh, vtkPolyData* points, double size) {
  Panel panel{make_renderer(size), "surface points", {}};
  vtkDataArray* origins = require_array(points->GetCellData(), "origin", points->GetNumberOfPoints());
  std::array<vtkIdType, 3> counts{};
  const auto origin_of = [&](vtkIdType i) { return std::clamp(static_cast<int>(origins->GetComponent(i, 0)), 0, 2); };
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) ++counts.at(static_cast<std::size_t>(origin_of(i)));
  panel.detail = grouped(counts[0]) + " on faces, " + grouped(counts[1]) + " on edges";
  if (counts[2] > 0) panel.detail += ", " + grouped(counts[2]) + " by repair";

  vtkNew<vtkPolyData> dots;
  dots->SetPoints(points->GetPoints());
  set_colors(dots->GetPointData(), points->GetNumberOfPoints(),
             [&](vtkIdType i) { return kOriginColors.at(static_cast<std::size_t>(origin_of(i))); });
  vtkNew<vtkDoubleArray> radii;
  radii->SetName("radius");
  radii->SetNumberOfValues(points->GetNumberOfPoints());
  // As large as leaves gaps between evenly spread points.
  const double spacing = size / std::sqrt(static_cast<double>(points->GetNumberOfPoints()));
  radii->Fill(std::clamp(0.75 * spacing, 0.006 * size, 0.02 * size));
  dots->GetPointData()->AddArray(radii);
  if (mesh != nullptr) panel.renderer->AddActor(make_actor(mesh, {0.93, 0.94, 0.95}));
  panel.renderer->AddActor(make_spheres(dots));
  return panel;
}

// The faces whose surface points are seen at more than kLeastAngle: without the sheets that run into every shallow
// edge.
Data without_shallow_faces(vtkPolyData* faces) {
  vtkDataArray* angles = require_array(faces->GetCellData(), "contact_angle", faces->GetNumberOfPolys());
  vtkNew<vtkCellArray> polygons;
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < faces->GetNumberOfPolys(); ++i) {
    if (angles->GetComponent(i, 0) < kMinAngle) continue;
    faces->GetPolys()->GetCellAtId(i, corners);
    polygons->InsertNextCell(corners);
  }
  auto result = Data::New();
  result->SetPoints(faces->GetPoints());
  result->GetPointData()->ShallowCopy(faces->GetPointData());
  result->SetPolys(polygons);
  return result;
}

Panel axis_panel(vtkPolyData* mesh, vtkPolyData* faces, double size, double line_width) {
  Panel panel{make_renderer(size), "medial axis", counted(faces->GetNumberOfPoints(), "sphere") + ", colour: radius"};
  vtkNew<vtkColorTransferFunction> colors;  // viridis, five of its colours
  double range[2];
  vtkDataArray* radii = require_array(faces->GetPointData(), "radius", faces->GetNumberOfPoints());
  radii->GetRange(range);
  constexpr std::array kViridis{rgb(0x440154), rgb(0x3b528b), rgb(0x21918c), rgb(0x5ec962), rgb(0xfde725)};
  for (std::size_t i = 0; i < kViridis.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(kViridis.size() - 1);
    colors->AddRGBPoint(range[0] + t * (range[1] - range[0]), kViridis[i][0], kViridis[i][1], kViridis[i][2]);
  }
  auto sheet = make_actor(without_shallow_faces(faces), kStone);
  sheet->GetProperty()->SetAmbient(0.35);
  sheet->GetProperty()->SetDiffuse(0.65);
  sheet->GetProperty()->SetSpecular(0);
  vtkMapper* mapper = sheet->GetMapper();
  mapper->ScalarVisibilityOn();
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("radius");
  mapper->SetLookupTable(colors);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  panel.renderer->AddActor(sheet);
  if (mesh != nullptr) {
    panel.renderer->AddActor(make_actor(mesh, {0.72, 0.78, 0.85}, 0.16));
    panel.renderer->AddActor(edges(mesh, kFeatureAngle, 0.8 * line_width, 0.5));
  }
  return panel;
}

// Inaccuracies as fractions of R, where they were measured.
std::string level_figures(vtkPolyData* spheres, double bounding_radius) {
  std::string text = counted(spheres->GetNumberOfPoints(), "sphere");
  vtkDataArray* inaccuracy = require_array(spheres->GetPointData(), "inaccuracy", spheres->GetNumberOfPoints());
  double sum = 0;
  for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i) sum += inaccuracy->GetComponent(i, 0);
  if (sum > 0 && bounding_radius > 0) {
    char figure[64];
    std::snprintf(figure, sizeof figure, ", mean inaccuracy %#.2g R",
                  sum / static_cast<double>(spheres->GetNumberOfPoints()) / bounding_radius);
    text += figure;
  }
  return text;
}

Panel level_panel(vtkPolyData* spheres, int level, double size, double bounding_radius) {
  Panel panel{make_renderer(size), "sphere-tree, level " + std::to_string(level),
              level_figures(spheres, bounding_radius)};
  vtkDataArray* branch = require_array(spheres->GetPointData(), "branch", spheres->GetNumberOfPoints());
  set_colors(spheres->GetPointData(), spheres->GetNumberOfPoints(), [&](vtkIdType i) {
    const auto index = static_cast<std::size_t>(std::max(0.0, branch->GetComponent(i, 0)));
    return kBranchColors.at(index % kBranchColors.size());
  });
  panel.renderer->AddActor(make_spheres(spheres));
  return panel;
}

// Pale where a value is 0, red where it is `max`.
vtkSmartPointer<vtkColorTransferFunction> error_colors(double max) {
  constexpr std::array kColors{rgb(0xdfe6ec), rgb(0xf4d58a), rgb(0xee8a3c), rgb(0xb3121d)};
  auto colors = vtkSmartPointer<vtkColorTransferFunction>::New();
  for (std::size_t i = 0; i < kColors.size(); ++i)
    colors->AddRGBPoint(std::max(max, 1e-12) * static_cast<double>(i) / static_cast<double>(kColors.size() - 1),
                        kColors[i][0], kColors[i][1], kColors[i][2]);
  return colors;
}

// The places of one measure, numbered; `span` says which numbers they have.
std::vector<Label> labels_of(vtkPolyData* places, int measure, std::string& span) {
  std::vector<Label> labels;
  if (places == nullptr) return labels;
  vtkPointData* arrays = places->GetPointData();
  const vtkIdType count = places->GetNumberOfPoints();
  vtkDataArray* measures = require_array(arrays, "measure", count);
  vtkDataArray* numbers = require_array(arrays, "number", count);
  vtkDataArray* outward = require_array(arrays, "outward", count);
  for (vtkIdType i = 0; i < count; ++i) {
    if (static_cast<int>(measures->GetComponent(i, 0)) != measure) continue;
    Label& label = labels.emplace_back();
    places->GetPoint(i, label.position.data());
    outward->GetTuple(i, label.outward.data());
    label.text = std::to_string(static_cast<int>(numbers->GetComponent(i, 0)));
  }
  if (!labels.empty()) span = "; worst: " + labels.front().text + " to " + labels.back().text;
  return labels;
}

std::string up_to(double max) {
  char text[64];
  std::snprintf(text, sizeof text, "0 to %.3g %% of the diagonal", max);
  return text;
}

Panel coverage_panel(vtkPolyData* mesh, vtkPolyData* points, vtkPolyData* places, double size, double line_width) {
  Panel panel{make_renderer(size), "surface left uncovered", {}};
  const vtkIdType count = points->GetNumberOfPoints();
  vtkDataArray* coverage = require_array(points->GetCellData(), "coverage", count);
  const double max = coverage->GetRange()[1];
  const auto colors = error_colors(max);
  vtkNew<vtkPolyData> dots;
  dots->SetPoints(points->GetPoints());
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
  std::string span;
  panel.labels = labels_of(places, 1, span);
  panel.detail = up_to(max) + span;
  return panel;
}

Panel protrusion_panel(vtkPolyData* mesh, vtkPolyData* medial, vtkPolyData* places, double size, double line_width) {
  Panel panel{make_renderer(size), "balls that protrude", {}};
  vtkDataArray* protrusion = require_array(medial->GetPointData(), "protrusion", medial->GetNumberOfPoints());
  const double max = protrusion->GetRange()[1];
  auto sheet = make_actor(medial, kStone);
  vtkMapper* mapper = sheet->GetMapper();
  mapper->ScalarVisibilityOn();
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray("protrusion");
  mapper->SetLookupTable(error_colors(max));
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  sheet->GetProperty()->SetLineWidth(static_cast<float>(2 * line_width));
  panel.renderer->AddActor(sheet);
  panel.renderer->AddActor(make_actor(mesh, {0.72, 0.78, 0.85}, 0.16));
  panel.renderer->AddActor(edges(mesh, kFeatureAngle, 0.8 * line_width, 0.5));
  std::string span;
  panel.labels = labels_of(places, 0, span);
  panel.detail = up_to(max) + span;
  return panel;
}

void extend(std::vector<Extent>& extents, vtkPolyData* data, const char* radius_array) {
  vtkDataArray* radii =
      radius_array == nullptr ? nullptr : require_array(data->GetPointData(), radius_array, data->GetNumberOfPoints());
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    Extent extent{{}, radii == nullptr ? 0 : radii->GetComponent(i, 0)};
    data->GetPoint(i, extent.center.data());
    extents.push_back(extent);
  }
}

}  // namespace

Panels make_panels(const std::filesystem::path& vtm, double line_width) {
  Panels result;
  const Blocks blocks(vtm);
  const Data mesh = blocks["mesh"], points = blocks["surface points"], faces = blocks["medial faces"];
  if (const Data medial = blocks["medial mesh"]; medial != nullptr && mesh != nullptr && points != nullptr) {
    extend(result.extents, mesh, nullptr);
    result.size = 0.5 * mesh->GetLength();
    for (const bool from_behind : {false, true}) {
      result.panels.push_back(coverage_panel(mesh, points, blocks["worst places"], result.size, line_width));
      result.panels.push_back(protrusion_panel(mesh, medial, blocks["worst places"], result.size, line_width));
      for (std::size_t i = result.panels.size() - 2; from_behind && i < result.panels.size(); ++i) {
        result.panels[i].from_behind = true;
        result.panels[i].caption += ", from behind";
      }
    }
    return result;
  }
  std::vector<Data> levels;  // from the root on
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
    result.panels.push_back(level_panel(levels[static_cast<std::size_t>(level)], level, result.size, bounding_radius));
  }
  return result;
}

}  // namespace orchard::detail
