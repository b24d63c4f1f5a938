#include "canonical_frame.h"

#include <cmath>

namespace orchard::detail {

CanonicalFrame::CanonicalFrame(const Box& box) : center_(box.min() + 0.5 * box.sizes()) {
  const double half = 0.5 * box.sizes().maxCoeff();
  if (half > 0) scale_ = half;
}

CanonicalFrame CanonicalFrame::without_lattice(const Box& box) {
  CanonicalFrame frame(box);
  frame.snaps_ = false;
  return frame;
}

Point CanonicalFrame::snapped(const Point& point, double lattice) const {
  if (!snaps_) return (point - center_) / scale_;
  Point result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] = lattice * std::nearbyint((point[axis] - center_[axis]) / scale_ / lattice);
  return result;
}

TriangleMesh CanonicalFrame::in(const TriangleMesh& mesh) const {
  TriangleMesh result{{}, mesh.triangles};
  result.vertices.reserve(mesh.vertices.size());
  for (const Point& vertex : mesh.vertices) result.vertices.push_back(in(vertex));
  return result;
}

Refinement CanonicalFrame::in(const Refinement& refinement) const {
  Refinement result{refinement.error / scale_, {}};
  for (const Refinement::Region& region : refinement.regions)
    result.regions.push_back(
        {{(region.where.center - center_) / scale_, region.where.radius / scale_}, region.error / scale_});
  return result;
}

Sphere CanonicalFrame::in(const Sphere& ball) const {
  return {in(ball.center), kLattice * std::ceil(ball.radius / scale_ / kLattice + 2)};
}

Sphere CanonicalFrame::out(const Sphere& ball) const {
  return {center_ + scale_ * ball.center, scale_ * (ball.radius + kMoved)};
}

}  // namespace orchard::detail
