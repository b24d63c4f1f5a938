#include "certificate/suspects.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "predicates/predicates.h"

namespace orchard::detail {
namespace {

constexpr std::size_t kBlock = 64;  // points that share a box

// Returns the deeper intruder, and the first of two that are equally deep.
Intruder deeper(const Intruder& a, const Intruder& b) { return b.depth > a.depth ? b : a; }

// Returns the power of a point with respect to a sphere: the squared radius minus the squared distance. Center and
// point are relative to a point on the sphere.
double power_of(const Vector& center, const Vector& point) { return 2 * center.dot(point) - point.squaredNorm(); }

// Returns an upper bound on the power of any point in a box. Along each axis, the power is greatest at the coordinate
// nearest to the center.
double max_power(const Vector& center, const Vector& min, const Vector& max) {
  // There are three rounding errors in each factor or term and two in each sum, here and in power_of().
  constexpr double kRoundings = 2 * 8 * kRounding;
  const Eigen::Array3d at = center.array().max(min.array()).min(max.array()), twice = 2 * center.array();
  return (at * (twice - at)).sum() + kRoundings * (at.abs() * (twice.abs() + at.abs())).sum();
}

const Point& corner(const Workspace& workspace, Index v, unsigned i) {
  return workspace.points[workspace.vertices[v].forming_points[i]];
}

}  // namespace

Intruder farthest_beyond(const Workspace& workspace, Index vertex, std::span<const Index> points, double diameter) {
  const Point& first = corner(workspace, vertex, 0);
  Vector normal;
  if (!sharp_normal(first, corner(workspace, vertex, 1), corner(workspace, vertex, 2), normal))
    return {diameter, kNone};
  Intruder farthest;
  for (const Index p : points) farthest = deeper(farthest, {normal.dot(workspace.points[p] - first), p});
  return farthest;
}

PointBlocks::PointBlocks(std::span<const Point> points) : boxes_((points.size() + kBlock - 1) / kBlock) {
  tbb::parallel_for(std::size_t{0}, boxes_.size(), [&](std::size_t b) {
    for (const Point& p : points.subspan(b * kBlock, std::min(kBlock, points.size() - b * kBlock))) boxes_[b].extend(p);
  });
}

Intruder PointBlocks::deepest_within(const Workspace& workspace, Index vertex, const FormingPoints& forming,
                                     double diameter) const {
  const Point &p0 = corner(workspace, vertex, 0), &p1 = corner(workspace, vertex, 1),
              &p2 = corner(workspace, vertex, 2), &p3 = corner(workspace, vertex, 3);
  Vector center;
  if (!sharp_circumcenter(p0, p1, p2, p3, center)) return {diameter, kNone};
  Intruder deepest;
  const std::size_t count = workspace.points.size();
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (max_power(center, boxes_[b].min() - p0, boxes_[b].max() - p0) <= deepest.depth) continue;
    for (std::size_t i = b * kBlock; i < std::min(count, (b + 1) * kBlock); ++i) {
      const auto point = static_cast<Index>(i);
      if (!forming.has(point)) continue;
      const Point& p = workspace.points[i];
      const double power = power_of(center, p - p0);
      if (power > deepest.depth && inside_sphere(p, p0, p1, p2, p3) == Sign::positive) deepest = {power, point};
    }
  }
  return {deepest.depth / std::min(center.norm(), diameter / 2), deepest.point};
}

}  // namespace orchard::detail
