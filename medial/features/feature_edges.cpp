#include "feature_edges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "orchard/geometry/angle.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/error.h"

namespace orchard::detail {
namespace {

constexpr int kShrinkingSteps = 20;           // of a ball that shrinks
constexpr double kFirstDistance = 0.1;        // of the height of the lower triangle: where the first ball is placed
constexpr double kGrowth = 2;                 // factor between a ball and the next larger one
constexpr double kFeatureTouching = 1e-3;     // of a ball's radius: how deep the surface may reach into it
constexpr double kWeak = 0.5;                 // of the smallest loss: edges above this continue a chain
constexpr std::array kPlaces{0.5, 0.2, 0.8};  // shares of an edge at which its wedge is examined

struct Side {
  Index triangle, side;
  Index a, b;  // vertices
  double loss;
};

double height(const Surface& surface, Index triangle, const Vector& base) {
  const auto [a, b, c] = surface.corners(triangle);
  return (b - a).cross(c - a).norm() / base.norm();
}

}  // namespace

double wedge_loss(const Surface& surface, Index triangle, std::size_t side, double part) {
  const Index other = surface.neighbors(triangle)[side];
  if (other == kNone) return 0;
  const auto corners = surface.corners(triangle);
  const Vector along = corners[(side + 1) % 3] - corners[side];
  const Vector &n = surface.normal(triangle), &m = surface.normal(other);
  const Vector sum = n + m;
  if (!(n.cross(m).dot(along) > 0) || !(sum.norm() > 0)) return 0;
  // A centre at distance s from the edge along the bisector has the distance s cos from both faces.
  const Vector inward = -sum.normalized();
  const double cosine = sum.norm() / 2, squared_sine = std::max(0.0, 1 - cosine * cosine);
  if (!(squared_sine > 0)) return 0;
  const Point place = corners[side] + part * along;
  // The growth factor is so small that each ball contains the gap between the previous ball and itself. The last ball
  // shrinks to where it touches another place. A search that began with a large ball might start beyond the whole
  // surface.
  const double growth = std::min(kGrowth, (1 + cosine) / (1 - cosine));
  double s = kFirstDistance * std::min(height(surface, triangle, along), height(surface, other, along));
  if (!(s > 0)) return 0;
  ClosestPoint nearest = surface.closest(place + s * inward);
  while (nearest.distance >= s * cosine * (1 - kFeatureTouching) && s < 2 * surface.bounding_radius()) {
    s *= growth;
    nearest = surface.closest(place + s * inward);
  }
  for (int step = 0; step < kShrinkingSteps && nearest.distance < s * cosine * (1 - kFeatureTouching); ++step) {
    // The ball in the wedge that also touches this place fulfils |place + s inward - nearest| = s cos.
    const Vector to = nearest.position - place;
    const double ahead = inward.dot(to), root = ahead * ahead - squared_sine * to.squaredNorm();
    if (!(ahead > 0) || !(root >= 0)) return 0;
    const double next = (ahead - std::sqrt(root)) / squared_sine;
    if (!(next < s)) break;
    s = next;
    nearest = surface.closest(place + s * inward);
  }
  return s * (1 - cosine);
}

FeatureEdges::FeatureEdges(const Surface& surface, const FeatureOptions& options)
    : has_(surface.mesh().triangles.size(), {0, 0, 0}) {
  std::vector<Side> sides;
  // No ball is larger than the bounding ball, so edges with a small angle have a small loss.
  const double least_turn =
      2 * std::acos(std::max(0.0, 1 - kWeak * options.min_loss / (2 * surface.bounding_radius())));
  const auto& triangles = surface.mesh().triangles;
  for (Index t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = surface.neighbors(t)[i];
      if (other == kNone || other < t) continue;
      if (angle_between(surface.normal(t), surface.normal(other)) < least_turn) continue;
      sides.push_back({t, static_cast<Index>(i), triangles[t][i], triangles[t][(i + 1) % 3], 0});
    }
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sides.size(), 32), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      for (const double part : kPlaces)
        sides[i].loss = std::max(sides[i].loss, wedge_loss(surface, sides[i].triangle, sides[i].side, part));
    }
  });
  std::erase_if(sides, [&](const Side& side) { return side.loss < kWeak * options.min_loss; });
  DisjointSets chain(static_cast<Index>(surface.mesh().vertices.size()));
  for (const Side& side : sides) chain.unite(side.a, side.b);
  std::vector<double> length(surface.mesh().vertices.size(), 0), most(surface.mesh().vertices.size(), 0);
  for (const Side& side : sides) {
    const Index root = chain.root(side.a);
    length[root] += (surface.mesh().vertices[side.a] - surface.mesh().vertices[side.b]).norm();
    most[root] = std::max(most[root], side.loss);
  }
  for (const Side& side : sides) {
    const Index root = chain.root(side.a);
    if (length[root] < options.min_length || most[root] < options.min_loss) continue;
    add(surface, side.triangle, side.side);
  }
  sort_edges();
}

FeatureEdges::FeatureEdges(const Surface& surface, std::span<const std::array<Index, 2>> edges)
    : has_(surface.mesh().triangles.size(), {0, 0, 0}) {
  const auto& triangles = surface.mesh().triangles;
  std::vector<std::array<Index, 2>> wanted;
  for (const auto& [a, b] : edges) wanted.push_back({std::min(a, b), std::max(a, b)});
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  for (Index t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangles[t][i], b = triangles[t][(i + 1) % 3], other = surface.neighbors(t)[i];
      if (other != kNone && other < t) continue;
      if (std::binary_search(wanted.begin(), wanted.end(), std::array{std::min(a, b), std::max(a, b)}))
        add(surface, t, i);
    }
  }
  sort_edges();
  for (const auto& edge : wanted) {
    if (!std::binary_search(edges_.begin(), edges_.end(), edge))
      throw InputError("feature edge from vertex " + std::to_string(edge[0]) + " to " + std::to_string(edge[1]) +
                       ": the mesh has no such edge");
  }
}

void FeatureEdges::add(const Surface& surface, Index triangle, std::size_t side) {
  has_[triangle][side] = 1;
  const auto& corners = surface.mesh().triangles[triangle];
  const Index a = corners[side], b = corners[(side + 1) % 3], other = surface.neighbors(triangle)[side];
  edges_.push_back({std::min(a, b), std::max(a, b)});
  for (std::size_t k = 0; other != kNone && k < 3; ++k) {
    if (surface.neighbors(other)[k] == triangle) has_[other][k] = 1;
  }
}

void FeatureEdges::sort_edges() {
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

}  // namespace orchard::detail
