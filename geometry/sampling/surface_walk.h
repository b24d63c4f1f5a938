#pragma once
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A point of a triangle, given by weights of the corners (none negative, sum 1), so that it cannot leave the triangle.
struct SurfacePoint {
  Index triangle = kNone;
  Vector weights = Vector::Zero();
};

Point position(const Surface& surface, const SurfacePoint& point);

// Moves a point along `step`, which lies in the plane of its triangle, and unfolds the rest of the step across every
// edge it meets. The walk ends where the step does, or at an edge that cannot be crossed because the triangle behind it
// is missing, has no area or is refused by may_cross(from, to).
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

  // Goes to the end of the step and returns -1; or to the first edge on the way, leaves in `step` what remains of it,
  // and returns that edge.
  int advance(SurfacePoint& point, Vector& step) const;
  void cross(SurfacePoint& point, Vector& step, int edge, Index to) const;

  const Surface& surface_;
};

}  // namespace orchard::detail
