#include "exact_side.h"

#include "inexact_kernel.h"

namespace orchard::detail {
namespace {

CgalKernel::Point_2 point(const std::array<double, 2>& p) { return {p[0], p[1]}; }
CgalKernel::Point_3 point(const Point& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

int exact_line_side(const std::array<double, 2>& p, const std::array<double, 2>& r, const std::array<double, 2>& q) {
  return CGAL::orientation(point(p), point(r), point(q));
}

int exact_plane_side(const std::array<Point, 3>& t, const Point& q) {
  return CGAL::orientation(point(t[0]), point(t[1]), point(t[2]), point(q));
}

}  // namespace orchard::detail
