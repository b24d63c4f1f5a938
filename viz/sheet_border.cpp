#include "sheet_border.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace orchard::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSpeck = 0.02;      // of the diagonal
constexpr double kOnSurface = 1e-6;  // of the diagonal: balls with a smaller radius are on the surface
constexpr int kSmoothings = 10;      // of a border; each moves a point halfway to the middle of its neighbours

class Sheets {
 public:
  Sheets(vtkPolyData* faces, double angle)
      : faces_(faces), radii_(require_array(faces->GetPointData(), "radius", faces->GetNumberOfPoints())) {
    vtkDataArray* angles = require_array(faces->GetCellData(), "contact_angle", faces->GetNumberOfPolys());
    vtkNew<vtkIdList> corners;
    for (vtkIdType i = 0; i < faces->GetNumberOfPolys(); ++i) {
      if (angles->GetComponent(i, 0) < angle) continue;
      faces->GetPolys()->GetCellAtId(i, corners);
      polygons_.emplace_back(corners->begin(), corners->end());
    }
    places_.resize(static_cast<std::size_t>(faces->GetNumberOfPoints()));
    for (std::size_t i = 0; i < places_.size(); ++i) faces->GetPoint(static_cast<vtkIdType>(i), places_[i].data());
  }

  void drop_specks(double smallest) {
    parent_.resize(places_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (const auto& polygon : polygons_)
      for (const vtkIdType corner : polygon) parent_[root(corner)] = root(polygon.front());
    std::vector<Eigen::AlignedBox3d> boxes(places_.size());
    for (const auto& polygon : polygons_)
      for (const vtkIdType corner : polygon)
        boxes[root(polygon.front())].extend(places_[static_cast<std::size_t>(corner)]);
    std::erase_if(polygons_,
                  [&](const auto& polygon) { return boxes[root(polygon.front())].diagonal().norm() < smallest; });
  }

  void straighten_borders() {
    std::map<std::pair<vtkIdType, vtkIdType>, int> uses;
    for (const auto& polygon : polygons_)
      for (std::size_t i = 0; i < polygon.size(); ++i)
        ++uses[std::minmax(polygon[i], polygon[(i + 1) % polygon.size()])];
    std::map<vtkIdType, std::vector<vtkIdType>> neighbors;
    for (const auto& [edge, count] : uses) {
      if (count != 1) continue;
      neighbors[edge.first].push_back(edge.second);
      neighbors[edge.second].push_back(edge.first);
    }
    for (int pass = 0; pass < kSmoothings; ++pass) {
      std::vector<std::pair<vtkIdType, Vector3d>> moved;
      for (const auto& [point, others] : neighbors) {
        if (others.size() != 2 || on_surface(point)) continue;
        moved.emplace_back(point, 0.5 * place(point) + 0.25 * (place(others[0]) + place(others[1])));
      }
      for (const auto& [point, to] : moved) place(point) = to;
    }
  }

  Data drawn() const {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Vector3d& place : places_) points->InsertNextPoint(place.data());
    vtkNew<vtkCellArray> cells;
    for (const auto& polygon : polygons_) cells->InsertNextCell(static_cast<vtkIdType>(polygon.size()), polygon.data());
    auto result = Data::New();
    result->SetPoints(points);
    result->GetPointData()->ShallowCopy(faces_->GetPointData());
    result->SetPolys(cells);
    return result;
  }

 private:
  // A refined axis ends there, on sharp edges of the mesh, so the border is not smoothed.
  bool on_surface(vtkIdType point) const { return radii_->GetComponent(point, 0) < kOnSurface * faces_->GetLength(); }
  Vector3d& place(vtkIdType point) { return places_[static_cast<std::size_t>(point)]; }
  std::size_t root(vtkIdType point) {
    auto i = static_cast<std::size_t>(point);
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  vtkPolyData* faces_;
  vtkDataArray* radii_;
  std::vector<std::vector<vtkIdType>> polygons_;
  std::vector<Vector3d> places_;
  std::vector<std::size_t> parent_;  // of the points, in a forest of connected parts
};

}  // namespace

Data drawn_sheets(vtkPolyData* faces, double angle) {
  Sheets sheets(faces, angle);
  sheets.drop_specks(kSpeck * faces->GetLength());
  sheets.straighten_borders();
  return sheets.drawn();
}

}  // namespace orchard::detail
