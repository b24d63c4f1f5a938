#include "octants.h"

#include <algorithm>
#include <array>

namespace orchard {
namespace {

// The margin of the overlap test for rounding, relative to the lengths in it. An octant that may touch a triangle
// counts.
constexpr double kSlack = 0x1p-44;

// Returns whether the projections of a triangle (relative to the centre of the box) and of the box on `axis` overlap.
bool overlap_on(const Vector& axis, const std::array<Point, 3>& corners, const Vector& half) {
  const double a = axis.dot(corners[0]), b = axis.dot(corners[1]), c = axis.dot(corners[2]);
  double extent = 0;
  for (const Point& p : corners) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  const double radius = axis.cwiseAbs().dot(half) + kSlack * axis.cwiseAbs().sum() * (extent + half.sum());
  return std::min({a, b, c}) <= radius && std::max({a, b, c}) >= -radius;
}

// Tests the separating axes of a triangle and a box: the axes of the box, the normal of the triangle, and the cross
// products of their edges.
bool triangle_meets_box(std::array<Point, 3> corners, const Box& box) {
  const Point center = box.center();
  const Vector half = box.sizes() / 2;
  for (Point& corner : corners) corner -= center;
  for (int axis = 0; axis < 3; ++axis)
    if (!overlap_on(Vector::Unit(axis), corners, half)) return false;
  const std::array<Vector, 3> edges{corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  if (!overlap_on(edges[0].cross(edges[1]), corners, half)) return false;
  for (const Vector& edge : edges)
    for (int axis = 0; axis < 3; ++axis)
      if (!overlap_on(edge.cross(Vector::Unit(axis)), corners, half)) return false;
  return true;
}

Box child_box(const Box& box, int which) {
  const Point center = box.center();
  Box child;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = (which >> axis) & 1;
    child.min()[axis] = upper ? center[axis] : box.min()[axis];
    child.max()[axis] = upper ? box.max()[axis] : center[axis];
  }
  return child;
}

}  // namespace

namespace {

constexpr int kMaxBoxHalvings = 8;  // for each box wanted: where one side of a
                                    // halved box is empty, there is no box more

void keep_if_occupied(const Surface& surface, const Octant& parent, const Box& box, std::vector<Octant>& parts) {
  Octant part{box, {}, kNone};
  for (Index triangle : parent.triangles)
    if (triangle_meets_box(surface.corners(triangle), box)) part.triangles.push_back(triangle);
  if (!part.triangles.empty()) parts.push_back(std::move(part));
}

}  // namespace

std::vector<Octant> occupied_parts(const Surface& surface, const Octant& parent, Index count) {
  if (count == 8) return occupied_children(surface, parent);
  std::vector<Octant> parts{parent};
  for (Index halving = 0; parts.size() < count && halving < kMaxBoxHalvings * count; ++halving) {
    const auto max = std::max_element(parts.begin(), parts.end(), [](const Octant& a, const Octant& b) {
      return a.box.diagonal().squaredNorm() < b.box.diagonal().squaredNorm();
    });
    const Octant whole = std::move(*max);
    parts.erase(max);
    int axis = 0;
    whole.box.sizes().maxCoeff(&axis);
    Box lower = whole.box, upper = whole.box;
    lower.max()[axis] = upper.min()[axis] = whole.box.center()[axis];
    keep_if_occupied(surface, whole, lower, parts);
    keep_if_occupied(surface, whole, upper, parts);
    if (parts.empty()) break;
  }
  return parts;
}

std::vector<Octant> occupied_children(const Surface& surface, const Octant& parent) {
  std::vector<Octant> children;
  for (int which = 0; which < 8; ++which) {
    Octant child{child_box(parent.box, which), {}, kNone};
    for (Index triangle : parent.triangles)
      if (triangle_meets_box(surface.corners(triangle), child.box)) child.triangles.push_back(triangle);
    if (!child.triangles.empty()) children.push_back(std::move(child));
  }
  return children;
}

}  // namespace orchard
