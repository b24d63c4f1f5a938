#include <algorithm>
#include <cmath>
#include <limits>

#include "exact_side.h"
#include "triangle_tree.h"
#include "triangle_tree_builder.h"

// The winding number by signed crossings of a ray, exact for every closed mesh and every query off the surface. The ray
// leaves the query q along an axis a, and (a, u, v) are the axes in cyclic order. A ray that meets an edge or a vertex
// is no special case, because the query is moved: in place of q, the point q + (e^3, e, e^2) along (a, u, v) is used,
// where e > 0 is as small as necessary. The moved point has the winding number of q, it lies in no triangle's plane,
// and its ray meets no edge. Its signs are those of q; where a sign of q is zero, the sign of the moved point is that
// of the first term in e that is not zero (simulation of simplicity; Edelsbrunner and Muecke 1990).

namespace orchard::detail {
namespace {

// On which side of the line from p to r, in the plane across the ray, the moved query lies: 0 only if p and r are in
// one line with the ray.
int side_of_edge(const Point& p, const Point& r, const Point& q, int u, int v) {
  const int side = line_side(p, r, q, u, v);
  if (side != 0) return side;
  return r[v] != p[v] ? sign_of(p[v] - r[v]) : sign_of(r[u] - p[u]);
}

// On which side of a triangle's plane the moved query lies. `along`: the sign of the normal's component along a, which
// is not 0.
int side_of_plane(const std::array<Point, 3>& t, const Point& q, int a, int along) {
  const int side = plane_side(t, q);
  if (side != 0) return side;
  const int u = (a + 1) % 3, v = (a + 2) % 3;
  const int along_u = line_side(t[0], t[1], t[2], v, a);
  if (along_u != 0) return along_u;
  const int along_v = line_side(t[0], t[1], t[2], a, u);
  return along_v != 0 ? along_v : along;
}

}  // namespace

class TriangleTree::Ray {
 public:
  // The ray goes towards the nearest side of the mesh's box, because the shortest way out meets the fewest triangles.
  Ray(const TriangleTree& tree, const Point& query) : query_(query) {
    const Vector local = tree.scale_ * (query - tree.center_);
    const Node& root = tree.nodes_[0];
    double min = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      float lower = kFloatInfinity, upper = -kFloatInfinity;
      for (int k = 0; k < 4; ++k)
        lower = std::min(lower, root.lower[axis][k]), upper = std::max(upper, root.upper[axis][k]);
      if (upper - local[axis] < min) min = upper - local[axis], a_ = axis, towards_ = 1;
      if (local[axis] - lower < min) min = local[axis] - lower, a_ = axis, towards_ = -1;
      below_[axis] = std::nextafter(static_cast<float>(local[axis]), -kFloatInfinity);
      above_[axis] = std::nextafter(static_cast<float>(local[axis]), kFloatInfinity);
    }
    u_ = (a_ + 1) % 3, v_ = (a_ + 2) % 3;
  }

  // For each child, a lane with all bits set if the ray may meet the child's box. Nothing is missed by rounding: boxes
  // are rounded outward, and the query is taken rounded down and rounded up.
  auto meets(const Node& node) const {
    const auto on_way = towards_ > 0 ? node.upper[a_] >= below_[a_] : node.lower[a_] <= above_[a_];
    return on_way & (node.lower[u_] <= above_[u_]) & (node.upper[u_] >= below_[u_]) & (node.lower[v_] <= above_[v_]) &
           (node.upper[v_] >= below_[v_]);
  }

  // +1 if the ray leaves the solid through the triangle (meets its front from behind), -1 if it enters, 0 if it misses.
  int crossing(const std::array<Point, 3>& t) const {
    if (beside(t, u_) || beside(t, v_)) return 0;
    const auto [low, high] = std::minmax({t[0][a_], t[1][a_], t[2][a_]});
    if (towards_ > 0 ? high < query_[a_] : low > query_[a_]) return 0;
    const int along = side_of_edge(t[0], t[1], query_, u_, v_);
    if (along == 0 || side_of_edge(t[1], t[2], query_, u_, v_) != along ||
        side_of_edge(t[2], t[0], query_, u_, v_) != along)
      return 0;
    const int leaving = along * towards_;
    const bool all_ahead = towards_ > 0 ? low > query_[a_] : high < query_[a_];
    return all_ahead || side_of_plane(t, query_, a_, along) == -leaving ? leaving : 0;
  }

 private:
  bool beside(const std::array<Point, 3>& t, int axis) const {
    const double q = query_[axis];
    return (t[0][axis] < q && t[1][axis] < q && t[2][axis] < q) || (t[0][axis] > q && t[1][axis] > q && t[2][axis] > q);
  }

  const Point& query_;
  int a_ = 0, u_ = 1, v_ = 2, towards_ = 1;
  float below_[3], above_[3];  // the query in the tree's coordinates, rounded both ways
};

int TriangleTree::winding_number(const Point& query) const {
  const Ray ray(*this, query);
  int sum = 0;
  std::array<Index, Builder::kStackSize> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Index entry = stack[--top];
    if (entry >= Builder::kLeaf) {
      for (const Index triangle : leaves_[entry - Builder::kLeaf].triangle)
        if (triangle != kNone) sum += ray.crossing(corners(triangle));
      continue;
    }
    const auto meets = ray.meets(nodes_[entry]);
    for (int k = 0; k < 4; ++k)
      if (meets[k]) stack[top++] = nodes_[entry].child[k];
  }
  return sum;
}

}  // namespace orchard::detail
