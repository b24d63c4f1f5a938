#include "tangent_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/geometry/angle.h"
#include "smooth_normal.h"

namespace orchard::detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSame = 1e-12;     // of a radius: two that differ by less are the same
constexpr double kLevel = 1e-9;     // descents below this are the rounding of normals
constexpr double kParallel = 1e-6;  // radians: normals that differ by less give the same ball

// By what part of its radius a ball on a smooth surface may be too small because the surface is made of facets. The
// largest part is that of facets that turn by almost ThicknessOptions::smooth, at contacts that are just far enough
// away to end the ball: (1 - cos(smooth / 2)) / (1 - cos(smooth)).
constexpr double kFacets = 0.25;
// Radians: angles that differ by less count as equal.
constexpr double kSameAngle = 1e-7;

// The angle between a place and another point, seen from the centre of the ball that touches both.
double seen_angle(const TangentPlace& place, const Point& other) {
  const Vector way = place.position - other;
  return 2 * std::asin(std::clamp(place.normal.dot(way) / way.norm(), 0.0, 1.0));
}

// The part of a triangle that one of its places lies on, up to rounding.
Feature feature_at(const std::array<Point, 3>& corners, const Point& at) {
  constexpr double kOnFeature = 1e-9;  // of the longest edge
  std::array<Vector, 3> edges;
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    edges[i] = corners[(i + 1) % 3] - corners[i];
    longest = std::max(longest, edges[i].norm());
  }
  const auto numbered = [](Feature first, std::size_t i) {
    return static_cast<Feature>(static_cast<std::size_t>(first) + i);
  };
  for (std::size_t i = 0; i < 3; ++i)
    if ((at - corners[i]).norm() <= kOnFeature * longest) return numbered(Feature::vertex0, i);
  for (std::size_t i = 0; i < 3; ++i)
    if (edges[i].cross(at - corners[i]).norm() <= kOnFeature * longest * edges[i].norm())
      return numbered(Feature::edge0, i);
  return Feature::face;
}

// A feature (face, edge or vertex) of the triangle `other` that `triangle` shares: which of `triangle`'s own it is.
Feature feature_on(const std::array<Index, 3>& triangle, const std::array<Index, 3>& other, Feature feature) {
  if (feature == Feature::face) return feature;
  const bool at_edge = feature <= Feature::edge2;
  const Feature first = at_edge ? Feature::edge0 : Feature::vertex0;
  const auto i = static_cast<std::size_t>(feature) - static_cast<std::size_t>(first);
  const Index a = other[i], b = at_edge ? other[(i + 1) % 3] : a;
  for (std::size_t k = 0; k < 3; ++k) {
    const Index c = triangle[k], d = at_edge ? triangle[(k + 1) % 3] : c;
    if ((a == c && b == d) || (a == d && b == c)) return static_cast<Feature>(static_cast<std::size_t>(first) + k);
  }
  return Feature::face;
}

}  // namespace

ThicknessAt TangentBallSearch::at(const SurfacePlace& place) {
  surface_.triangles_at(place.triangle, place.feature, around_);
  const auto& triangles = surface_.mesh().triangles;
  parts_.clear();
  for (const Index triangle : around_)
    parts_.emplace_back(triangle, feature_on(triangles[triangle], triangles[place.triangle], place.feature));
  std::sort(around_.begin(), around_.end());

  ThicknessAt best;
  ended_ = kNone;
  best.diameter = best.thickness = kNaN;
  best.contact = place.position;
  const Vector main = smooth_normal(surface_, place, std::cos(options_.smooth));
  best.normal = main;
  if (!(main.norm() > 0)) return best;
  try_normal(place, main, best);
  if (place.feature != Feature::face && options_.definition == ThicknessDefinition::ball) {
    for (const auto& [triangle, feature] : parts_) {
      const Vector& normal = surface_.normal(triangle);
      if (normal.isZero(0) || angle_between(normal, main) < kParallel) continue;
      const bool concave = std::all_of(parts_.begin(), parts_.end(), [&](const auto& part) {
        return descent_at(normal, surface_.corners(part.first), surface_.normal(part.first), part.second) <= kLevel;
      });
      if (concave) try_normal(place, normal, best);
    }
  }
  if (ended_ != kNone) set_thickness(place, best);
  return best;
}

void TangentBallSearch::try_normal(const SurfacePlace& place, const Vector& normal, ThicknessAt& best) {
  const TangentPlace tangent{place.position, normal, std::sin(options_.smooth / 2)};
  const bool rays = options_.definition == ThicknessDefinition::ray;
  const bool vanishes = !rays && std::any_of(parts_.begin(), parts_.end(), [&](const auto& part) {
    return descent_at(normal, surface_.corners(part.first), surface_.normal(part.first), part.second) > tangent.sine;
  });
  if (vanishes) {
    if (std::isnan(best.diameter)) best.diameter = 0;
    return;
  }
  // In the cone, depth >= sine x distance: no radius is above distance / (2 sine).
  const Box& box = surface_.bounding_box();
  const double farthest = (place.position - box.center()).norm() + box.diagonal().norm() / 2;
  run(first_, tangent, {farthest / tangent.sine, std::isnan(best.diameter) ? -1 : best.diameter / 2});
  if (touched_ == kNone || 2 * found_.radius <= best.diameter) return;
  ended_ = touched_;
  best.diameter = 2 * found_.radius;
  best.error = 2 * (found_.radius - low_);
  best.normal = normal;
  best.contact = found_.at;
  best.angle = rays ? angle_between(normal, surface_.normal(touched_)) : seen_angle(tangent, found_.at);
}

// The largest angle between a triangle's normal and a neighbour's, among neighbours that continue it smoothly.
double TangentBallSearch::turn_around(Index triangle) const {
  double most = 0;
  for (const Index next : surface_.neighbors(triangle)) {
    if (next == kNone) continue;
    const double turn = angle_between(surface_.normal(triangle), surface_.normal(next));
    if (turn < options_.smooth) most = std::max(most, turn);
  }
  return most;
}

// The contact that faces the place need not be the first that the ball meets, because the facets of a smooth surface
// all lie a little off it: so a slightly larger ball is searched whose contact does face the place. The ball may grow
// only by as much as facets explain, so a wall that ended it at a smaller angle is not passed over.
void TangentBallSearch::set_thickness(const SurfacePlace& place, ThicknessAt& at) {
  at.thickness = at.angle >= options_.facing - kSameAngle ? at.diameter : kNaN;
  if (!std::isnan(at.thickness) || options_.definition == ThicknessDefinition::ray) return;
  // No thickness is below the diameter. If the diameter is uncertain, so is whether a thickness explains it.
  const double low = at.diameter - at.error;
  const bool certain = at.error == 0;
  double turn = 0;
  surface_.triangles_at(ended_, feature_at(surface_.corners(ended_), at.contact), around_end_);
  for (const Index triangle : around_end_) turn = std::max(turn, turn_around(triangle));
  for (const auto& [triangle, feature] : parts_) turn = std::max(turn, turn_around(triangle));
  const double limit = at.diameter / 2 / (1 - kFacets * turn / options_.smooth);
  max_cosine_ = std::cos(std::max(options_.facing - turn / 2 - kSameAngle, 0.0));
  const TangentPlace tangent{place.position, at.normal, std::sin(options_.facing / 2)};
  run(facing_, tangent, {limit * (1 + kSame), -1});
  max_cosine_ = 1;
  if (touched_ == kNone) {
    // A search that ended early may have missed a facing contact.
    if (!certain || low_ < found_.radius) at.error = std::numeric_limits<double>::infinity();
    return;
  }
  at.error = std::max(at.error, 2 * found_.radius - (certain ? 2 * low_ : low));
  at.thickness = 2 * found_.radius;
  at.contact = found_.at;
  at.angle = seen_angle(tangent, found_.at);
}

SlabTree::Lanes TangentBallSearch::bounds(const SlabTree::Node& node, const TangentPlace& place) const {
  const SlabTree::Limits limits{found_.radius, max_cosine_};
  return options_.definition == ThicknessDefinition::ray ? SlabTree::min_ray(node, place, limits)
                                                         : SlabTree::min_touch(node, place, limits);
}

void TangentBallSearch::run(Search& search, const TangentPlace& place, const Radii& radii) {
  found_ = {radii.limit, place.position};
  touched_ = kNone;
  work_ = 0;
  low_ = 0;
  if (search.touched != kNone && look_at(place, search.touched)) slide(place);
  if (found_.radius > radii.enough) this->search(place, search.may_miss, radii.enough);
  if (low_ < found_.radius && touched_ != kNone) slide(place);
  search.touched = touched_;
}

// Visits the node with the least bound on the ball first, until no bound is below the ball that was found.
void TangentBallSearch::search(const TangentPlace& place, bool may_miss, double enough) {
  waiting_.assign(1, {0, 0});
  while (!waiting_.empty()) {
    const Entry top = waiting_.front();
    low_ = top.bound;
    if (low_ >= (1 - kSame) * found_.radius) break;
    if (found_.radius <= enough || (work_ >= options_.work && (may_miss || touched_ != kNone))) return;
    std::pop_heap(waiting_.begin(), waiting_.end());
    waiting_.pop_back();
    descend(place, top.node);
  }
  low_ = found_.radius;
}

// Goes down to a leaf, at every node to the child with the least bound. The other children wait in the queue.
void TangentBallSearch::descend(const TangentPlace& place, Index index) {
  while (true) {
    const SlabTree::Node& node = tree_.nodes()[index];
    const SlabTree::Lanes bounds = this->bounds(node, place);
    work_ += node.count;
    if (node.is_leaf) {
      for (Index i = 0; i < node.count; ++i)
        if (bounds[i] < found_.radius) look_at(place, node.children[i]);
      return;
    }
    Index nearest = 0;
    for (Index i = 1; i < node.count; ++i)
      if (bounds[i] < bounds[nearest]) nearest = i;
    for (Index i = 0; i < node.count; ++i) {
      if (i == nearest || !(bounds[i] < found_.radius)) continue;
      waiting_.push_back({bounds[i], node.children[i]});
      std::push_heap(waiting_.begin(), waiting_.end());
    }
    if (!(bounds[nearest] < found_.radius)) return;
    index = node.children[nearest];
  }
}

// Goes from triangle to triangle across edges as long as the ball gets smaller. Where the search ended early, the ball
// then at least touches the surface without cutting the triangles beside the contact.
void TangentBallSearch::slide(const TangentPlace& place) {
  for (bool better = true; better;) {
    better = false;
    const std::array<Index, 3> neighbors = surface_.neighbors(touched_);
    for (const Index next : neighbors) {
      if (next != kNone && look_at(place, next)) better = true;
    }
  }
}

bool TangentBallSearch::look_at(const TangentPlace& place, Index triangle) {
  if (std::binary_search(around_.begin(), around_.end(), triangle)) return false;
  if (max_cosine_ < 1 && surface_.normal(triangle).dot(place.normal) > max_cosine_) return false;
  const auto corners = surface_.corners(triangle);
  const Touch touch = options_.definition == ThicknessDefinition::ray
                          ? ray_through_triangle(place, corners, surface_.normal(triangle))
                          : touch_of_triangle(place, corners, surface_.normal(triangle), found_.radius);
  if (!(touch.radius < found_.radius)) return false;
  found_ = touch;
  touched_ = triangle;
  return true;
}

}  // namespace orchard::detail
