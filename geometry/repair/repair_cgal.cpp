#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <iterator>

#include "repair_steps.h"

namespace orchard::detail {

std::vector<std::array<Index, 3>> triangulate_polyline(std::span<const Point> polyline) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  points.reserve(polyline.size());
  for (const Point& p : polyline) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<CGAL::Triple<int, int, int>> cap;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(cap));
  std::vector<std::array<Index, 3>> triangles;
  triangles.reserve(cap.size());
  for (const auto& t : cap)
    triangles.push_back({static_cast<Index>(t.first), static_cast<Index>(t.second), static_cast<Index>(t.third)});
  return triangles;
}

}  // namespace orchard::detail
