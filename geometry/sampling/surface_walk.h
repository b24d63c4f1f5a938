#pragma once
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A point that cannot leave its triangle: weights of the corners, not negative, with sum 1.
struct SurfacePoint {
  Index triangle = kNone;
  Vector weights = Vector::Zero();
};

Point position(const Surface& surface, const SurfacePoint& point);

// Moves a point along `step`, which lies in the plane of its triangle, and unfolds the rest of the step across every
// edge it meets. The walk ends where the step does or at an edge without a usable neighbour: one that is missing, of no
// area, or not accepted by may_cross(from, to).
class SurfaceWalker {
 public:
  explicit SurfaceWalker(const Surface& surface) : surface_(surface) {}

  template <class MayCross>
  void walk(SurfacePoint& point, Vector step, const MayCross& may_cross) const {
    for (int crossings = 0; crossings < kMaxCrossings; ++crossings) {
      const int edge = advance(point, step);
      if (edge < 0) return;
      const Index to = surface_.neighbors(point.triangle)[static_cast<std::size_t>(edge)];
      if (to == kNone || surface_.area(to) == 0 || !may_cross(point.triangle, to)) return;
      cross(point, step, edge, to);
    }
  }

 private:
  static constexpr int kMaxCrossings = 100;  // more only if a step winds around a vertex

  // Goes to the end of the step, or to the first edge on its way: then `step` is what remains, and the edge is
  // returned.
  int advance(SurfacePoint& point, Vector& step) const;
  void cross(SurfacePoint& point, Vector& step, int edge, Index to) const;

  const Surface& surface_;
};

}  // namespace orchard::detail
