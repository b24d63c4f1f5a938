#include <CGAL/Intersections_3/Segment_3_Segment_3.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <algorithm>
#include <variant>

#include "inexact_kernel.h"
#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

using detail::CgalKernel;
using Shape = std::variant<CgalKernel::Point_3, CgalKernel::Segment_3, CgalKernel::Triangle_3>;

// CGAL's intersection tests are exact but need shapes of full dimension.
Shape shape_of(const std::array<Point, 3>& corners) {
  std::array<CgalKernel::Point_3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
  if (!CGAL::collinear(p[0], p[1], p[2])) return CgalKernel::Triangle_3(p[0], p[1], p[2]);
  const auto [first, last] = std::minmax_element(p.begin(), p.end());  // along the line, the ends
  if (*first == *last) return *first;
  return CgalKernel::Segment_3(*first, *last);
}

bool meet(const CgalKernel::Point_3& a, const CgalKernel::Point_3& b) { return a == b; }
bool meet(const CgalKernel::Point_3& a, const CgalKernel::Segment_3& b) { return b.has_on(a); }
bool meet(const CgalKernel::Point_3& a, const CgalKernel::Triangle_3& b) { return b.has_on(a); }
template <class A>
bool meet(const A& a, const CgalKernel::Point_3& b) {
  return a.has_on(b);
}
template <class A, class B>
bool meet(const A& a, const B& b) {
  return CGAL::do_intersect(a, b);
}

}  // namespace

bool triangles_meet(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  return std::visit([](const auto& p, const auto& q) { return meet(p, q); }, shape_of(a), shape_of(b));
}

}  // namespace orchard
