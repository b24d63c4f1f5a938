#include "suspects.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

#include "predicates.h"

namespace orchard::detail {
namespace {

constexpr Index kBlock = 1u << 14;  // points that a thread looks at at once

// The first of two that are as deep.
Intruder deeper(const Intruder& a, const Intruder& b) { return b.depth > a.depth ? b : a; }

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

Intruder deepest_within(const Workspace& workspace, Index vertex, const FormingPoints& forming, double diameter) {
  const Point &p0 = corner(workspace, vertex, 0), &p1 = corner(workspace, vertex, 1),
              &p2 = corner(workspace, vertex, 2), &p3 = corner(workspace, vertex, 3);
  Vector center;
  if (!sharp_circumcenter(p0, p1, p2, p3, center)) return {diameter, kNone};
  const auto count = static_cast<Index>(workspace.points.size());
  const Intruder deepest = tbb::parallel_reduce(
      tbb::blocked_range<Index>(0, count, kBlock), Intruder{},
      [&](const auto& range, Intruder max) {
        for (Index i = range.begin(); i < range.end(); ++i) {
          if (!forming.has(i)) continue;
          const Point& p = workspace.points[i];
          const Vector from_p0 = p - p0;
          const double by_center = 2 * center.dot(from_p0) - from_p0.squaredNorm();
          if (by_center > max.depth && inside_sphere(p, p0, p1, p2, p3) == Sign::positive) max = {by_center, i};
        }
        return max;
      },
      deeper);
  return {deepest.depth / std::min(center.norm(), diameter / 2), deepest.point};
}

}  // namespace orchard::detail
