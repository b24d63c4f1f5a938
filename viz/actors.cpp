#include "actors.h"

#include <vtkDoubleArray.h>
#include <vtkFeatureEdges.h>
#include <vtkGlyph3DMapper.h>
#include <vtkLightKit.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace orchard::detail {
namespace {

constexpr vtkIdType kTrianglesOutlined = 20000;  // with more triangles, their outlines would turn the mesh black

}  // namespace

vtkDataArray* require_array(vtkDataSetAttributes* data, const char* name, vtkIdType count) {
  vtkDataArray* array = data->GetArray(name);
  if (array == nullptr || array->GetNumberOfTuples() != count) {
    throw std::runtime_error(std::string("a file has no complete array '") + name + "'");
  }
  return array;
}
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

vtkSmartPointer<vtkActor> make_actor(vtkMapper* mapper, const Color& color, double opacity) {
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

vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data, const Color& color, double opacity) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  return make_actor(mapper, color, opacity);
}

vtkSmartPointer<vtkActor> edges(vtkPolyData* mesh, double angle, double width, double opacity) {
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

vtkSmartPointer<vtkActor> make_dots(vtkPolyData* points, double size) {
  vtkNew<vtkDoubleArray> radii;
  radii->SetName("radius");
  radii->SetNumberOfValues(points->GetNumberOfPoints());
  const double spacing = size / std::sqrt(static_cast<double>(points->GetNumberOfPoints()));
  radii->Fill(std::clamp(0.75 * spacing, 0.006 * size, 0.02 * size));
  points->GetPointData()->AddArray(radii);
  return make_spheres(points);
}

vtkSmartPointer<vtkActor> make_sheet(vtkPolyData* data, const char* name, vtkColorTransferFunction* colors) {
  auto sheet = make_actor(data, kStone);
  sheet->GetProperty()->SetAmbient(0.35);
  sheet->GetProperty()->SetDiffuse(0.65);
  sheet->GetProperty()->SetSpecular(0);
  vtkMapper* mapper = sheet->GetMapper();
  mapper->ScalarVisibilityOn();
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectColorArray(name);
  mapper->SetLookupTable(colors);
  mapper->UseLookupTableScalarRangeOn();
  mapper->InterpolateScalarsBeforeMappingOn();
  return sheet;
}

void add_mesh(vtkRenderer* renderer, vtkPolyData* mesh, double line_width) {
  auto faces = make_actor(mesh, kStone);
  faces->GetProperty()->SetInterpolationToFlat();
  renderer->AddActor(faces);
  renderer->AddActor(edges(mesh, kFeatureAngle, 1.2 * line_width));
  if (mesh->GetNumberOfPolys() <= kTrianglesOutlined) renderer->AddActor(edges(mesh, 0, 0.5 * line_width, 0.35));
}

vtkSmartPointer<vtkActor> add_glass(vtkRenderer* renderer, vtkPolyData* mesh, double line_width, double opacity) {
  auto faces = make_actor(mesh, kGlass, opacity);
  renderer->AddActor(faces);
  renderer->AddActor(edges(mesh, kFeatureAngle, 0.8 * line_width, 0.5));
  return faces;
}

vtkSmartPointer<vtkActor> make_level(vtkPolyData* spheres) {
  vtkDataArray* branch = require_array(spheres->GetPointData(), "branch", spheres->GetNumberOfPoints());
  set_colors(spheres->GetPointData(), spheres->GetNumberOfPoints(), [&](vtkIdType i) {
    const auto index = static_cast<std::size_t>(std::max(0.0, branch->GetComponent(i, 0)));
    return kBranchColors.at(index % kBranchColors.size());
  });
  return make_spheres(spheres);
}

vtkSmartPointer<vtkColorTransferFunction> transfer_function(const ColorMap& map, const double range[2]) {
  auto colors = vtkSmartPointer<vtkColorTransferFunction>::New();
  for (std::size_t i = 0; i < map.colors.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(map.colors.size() - 1);
    colors->AddRGBPoint(range[0] + t * (range[1] - range[0]), map.colors[i][0], map.colors[i][1], map.colors[i][2]);
  }
  return colors;
}

vtkSmartPointer<vtkColorTransferFunction> error_colors(double max) {
  const double range[2] = {0, std::max(max, 1e-12)};
  return transfer_function(kHeat, range);
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

}  // namespace orchard::detail
