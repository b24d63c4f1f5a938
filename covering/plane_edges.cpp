#include "plane_edges.h"

#include <algorithm>
#include <cmath>

#include "orchard/geometry/error.h"

namespace orchard::detail {
namespace {

// The sum of 12 doubles as an expansion of non-overlapping ones (Shewchuk 1997). The last one that is not zero has the
// sign of the sum.
class ExactSum {
 public:
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }
  int sign() const {
    for (int i = size_ - 1; i >= 0; --i)
      if (parts_[static_cast<std::size_t>(i)] != 0) return parts_[static_cast<std::size_t>(i)] > 0 ? 1 : -1;
    return 0;
  }

 private:
  void add(double value) {
    for (int i = 0; i < size_; ++i) {
      double& part = parts_[static_cast<std::size_t>(i)];
      const double sum = value + part, back = sum - value;
      part = (value - (sum - back)) + (part - back);
      value = sum;
    }
    parts_[static_cast<std::size_t>(size_++)] = value;
  }
  std::array<double, 12> parts_{};
  int size_ = 0;
};

bool finite(std::span<const PlanePoint> points) {
  return std::all_of(points.begin(), points.end(), [](const PlanePoint& p) {
    // Products of coordinates must neither overflow nor underflow.
    const double size = p.cwiseAbs().maxCoeff();
    return std::isfinite(size) && size < 1e100;
  });
}

bool in_triangle(const PlanePoint& p, const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return exact_orientation(a, b, p) >= 0 && exact_orientation(b, c, p) >= 0 && exact_orientation(c, a, p) >= 0;
}

double area_twice(std::span<const PlanePoint> polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanePoint p = polygon[i] - polygon[0], q = polygon[(i + 1) % polygon.size()] - polygon[0];
    sum += p.x() * q.y() - p.y() * q.x();
  }
  return sum;
}

bool edges_cross(const Edge& p, const Edge& q) {
  return p.side_of(q.a) * p.side_of(q.b) < 0 && q.side_of(p.a) * q.side_of(p.b) < 0;
}

}  // namespace

int exact_orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  const double difference = left - right;
  if (std::abs(difference) > 0x1p-50 * (std::abs(left) + std::abs(right))) return difference > 0 ? 1 : -1;
  ExactSum sum;
  sum.add_product(a.x(), b.y());
  sum.add_product(-a.x(), c.y());
  sum.add_product(-c.x(), b.y());
  sum.add_product(-a.y(), b.x());
  sum.add_product(a.y(), c.x());
  sum.add_product(c.y(), b.x());
  return sum.sign();
}

bool cross_in_one_point(const Edge& p, const Edge& q, const Edge& crossed) {
  if (p.on_line_of(q)) return true;
  for (const PlanePoint& corner : {p.a, p.b})
    if ((corner == q.a || corner == q.b) && crossed.side_of(corner) == 0) return true;
  return false;
}

std::vector<Edge> edges_of(std::span<const PlanePoint> corners) {
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < corners.size(); ++i) edges.push_back({corners[i], corners[(i + 1) % corners.size()]});
  return edges;
}

std::vector<PlanePoint> convex_corners(std::span<const PlanePoint> corners) {
  if (corners.size() < 3 || !finite(corners)) throw InputError("a polygon needs three or more finite corners");
  std::vector<PlanePoint> result(corners.begin(), corners.end());
  if (area_twice(corners) < 0) std::reverse(result.begin(), result.end());
  // The polygon is strictly convex and goes round once if every corner is left of every edge that it is not on.
  for (const Edge& edge : edges_of(result))
    for (const PlanePoint& p : result)
      if (p != edge.a && p != edge.b && edge.side_of(p) <= 0)
        throw InputError("a polygon is not strictly convex: leave out corners on its sides and split what is concave");
  return result;
}

std::vector<std::array<PlanePoint, 3>> triangulated(std::span<const PlanePoint> polygon) {
  if (polygon.size() < 3 || !finite(polygon)) throw InputError("the region needs three or more finite corners");
  std::vector<PlanePoint> left(polygon.begin(), polygon.end());
  if (area_twice(polygon) < 0) std::reverse(left.begin(), left.end());
  const std::vector<Edge> edges = edges_of(left);
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (edges_cross(edges[i], edges[k])) throw InputError("the region's border crosses itself");
  std::vector<std::array<PlanePoint, 3>> triangles;
  while (left.size() > 2) {
    const std::size_t n = left.size();
    std::size_t ear = 0;
    for (; ear < n; ++ear) {
      const PlanePoint &a = left[(ear + n - 1) % n], &b = left[ear], &c = left[(ear + 1) % n];
      const int turn = exact_orientation(a, b, c);
      if (turn < 0) continue;
      if (turn == 0) break;  // it is a corner on a side, or a spike without area
      const bool empty = std::none_of(left.begin(), left.end(), [&](const PlanePoint& p) {
        return p != a && p != b && p != c && in_triangle(p, a, b, c);
      });
      if (!empty) continue;
      triangles.push_back({a, b, c});
      break;
    }
    if (ear == n) throw InputError("the region's border touches or crosses itself");
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  if (triangles.empty()) throw InputError("the region has no area");
  return triangles;
}

}  // namespace orchard::detail
