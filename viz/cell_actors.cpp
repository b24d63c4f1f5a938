#include "cell_actors.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkProperty.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

namespace orchard::detail {
namespace {

constexpr double kRounding = 1e-6;  // of the diagonal: inaccuracy up to this counts as rounding
constexpr double kShrink = 0.93;    // the drawn size of a cell over its size, so that gaps show where it ends

Eigen::Vector3d corner(vtkDataSet* data, vtkIdType point) {
  Eigen::Vector3d result;
  data->GetPoint(point, result.data());
  return result;
}

// Consecutive numbers get different colours.
Color cell_color(vtkIdType cell) {
  const auto mixed = static_cast<std::uint64_t>(cell) * 0x9e3779b97f4a7c15U;
  Color color = kBranchColors.at((mixed >> 40) % kBranchColors.size());
  for (double& c : color) c = 0.35 + 0.65 * c;
  return color;
}

// Returns the polyhedra of the half that is away from the eye, or all of them, each shrunk towards its middle.
Data parted(vtkUnstructuredGrid* grid, const Backward& backward) {
  const Eigen::Vector3d to_eye = backward ? Eigen::Vector3d(backward->data()) : Eigen::Vector3d::Zero();
  const double middle = Eigen::Vector3d(grid->GetCenter()).dot(to_eye);
  vtkDataArray* inaccuracy = require_array(grid->GetCellData(), "inaccuracy", grid->GetNumberOfCells());
  const double max = inaccuracy->GetRange()[1];
  const bool wrong = is_inaccurate(grid);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> polygons;
  std::vector<Color> colors;
  vtkNew<vtkIdList> corners, stream;
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
    grid->GetCellPoints(i, corners);
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    for (const vtkIdType id : *corners) center += corner(grid, id) / static_cast<double>(corners->GetNumberOfIds());
    if (center.dot(to_eye) > middle) continue;
    Color color = cell_color(i);
    if (wrong) color = color_at(kHeat, std::sqrt(inaccuracy->GetComponent(i, 0) / max));
    grid->GetFaceStream(i, stream);
    vtkIdType at = 1;
    for (vtkIdType face = 0; face < stream->GetId(0); ++face) {
      const vtkIdType count = stream->GetId(at++);
      polygons->InsertNextCell(static_cast<int>(count));
      for (vtkIdType k = 0; k < count; ++k) {
        const Eigen::Vector3d place = center + kShrink * (corner(grid, stream->GetId(at++)) - center);
        polygons->InsertCellPoint(points->InsertNextPoint(place.data()));
      }
      colors.push_back(color);
    }
  }
  auto result = Data::New();
  result->SetPoints(points);
  result->SetPolys(polygons);
  set_colors(result->GetCellData(), polygons->GetNumberOfCells(),
             [&](vtkIdType i) { return colors[static_cast<std::size_t>(i)]; });
  return result;
}

}  // namespace

bool is_inaccurate(vtkUnstructuredGrid* grid) {
  return require_array(grid->GetCellData(), "inaccuracy", grid->GetNumberOfCells())->GetRange()[1] >
         kRounding * grid->GetLength();
}

vtkSmartPointer<vtkActor> make_cells(vtkUnstructuredGrid* grid, const Backward& backward, double line_width) {
  auto actor = make_actor(parted(grid, backward), kStone);
  vtkMapper* mapper = actor->GetMapper();
  mapper->ScalarVisibilityOn();
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectColorArray("color");
  vtkProperty* property = actor->GetProperty();
  property->SetInterpolationToFlat();
  property->SetDiffuse(0.72);  // so that pale colours do not turn white in bright light
  property->EdgeVisibilityOn();
  property->SetEdgeColor(kInk[0], kInk[1], kInk[2]);
  property->SetLineWidth(static_cast<float>(0.5 * line_width));
  return actor;
}

}  // namespace orchard::detail
