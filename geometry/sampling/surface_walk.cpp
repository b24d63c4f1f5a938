#include "surface_walk.h"

#include <algorithm>

namespace orchard::detail {
namespace {

// The component of `v` at right angles to the unit vector `along`, normalized.
Vector across(const Vector& v, const Vector& along) { return (v - v.dot(along) * along).normalized(); }

void normalize(Vector& weights) {
  weights = weights.cwiseMax(0.0);
  weights /= weights.sum();
}

}  // namespace

Point position(const Surface& surface, const SurfacePoint& point) {
  const auto [a, b, c] = surface.corners(point.triangle);
  return a + point.weights[1] * (b - a) + point.weights[2] * (c - a);
}

int SurfaceWalker::advance(SurfacePoint& point, Vector& step) const {
  const auto p = surface_.corners(point.triangle);
  const Vector& normal = surface_.normal(point.triangle);
  const double twice_area = 2 * surface_.area(point.triangle);
  Vector rates;  // of change of the weights along the step
  for (int i = 0; i < 3; ++i) {
    const auto next = static_cast<std::size_t>((i + 1) % 3), last = static_cast<std::size_t>((i + 2) % 3);
    rates[i] = normal.cross(p[last] - p[next]).dot(step) / twice_area;
  }
  double reached = 1;
  int corner = -1;  // the corner opposite the edge that is met first
  for (int i = 0; i < 3; ++i) {
    if (rates[i] >= 0 || point.weights[i] + reached * rates[i] >= 0) continue;
    reached = point.weights[i] / -rates[i];
    corner = i;
  }
  point.weights += reached * rates;
  if (corner >= 0) point.weights[corner] = 0;
  normalize(point.weights);
  step *= 1 - reached;
  return corner < 0 ? -1 : (corner + 1) % 3;
}

void SurfaceWalker::cross(SurfacePoint& point, Vector& step, int edge, Index to) const {
  const auto& vertices = surface_.mesh().vertices;
  const auto& from = surface_.mesh().triangles[point.triangle];
  const auto start = static_cast<std::size_t>(edge), end = (start + 1) % 3, apex = (start + 2) % 3;
  const Point& origin = vertices[from[start]];
  const Vector along = (vertices[from[end]] - origin).normalized();
  const Vector outward = -across(vertices[from[apex]] - origin, along);

  SurfacePoint landed{to, Vector::Zero()};
  const auto& corners = surface_.mesh().triangles[to];
  Vector inward = outward;
  for (std::size_t i = 0; i < 3; ++i) {
    double& weight = landed.weights[static_cast<int>(i)];
    if (corners[i] == from[start])
      weight = point.weights[edge];
    else if (corners[i] == from[end])
      weight = point.weights[(edge + 1) % 3];
    else
      inward = across(vertices[corners[i]] - origin, along);
  }
  step = step.dot(along) * along + step.dot(outward) * inward;
  normalize(landed.weights);
  point = landed;
}

}  // namespace orchard::detail
