#include <algorithm>
#include <cmath>
#include <limits>

#include "slab_tree.h"

namespace orchard::detail {
namespace {

using Lanes = SlabTree::Lanes;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMargin = 1e-12;  // of squared lengths: far more than their roundings

// What the bounds of a child depend on.
struct Seen {
  Lanes squared;        // of the distance from the place to the child's centre
  Lanes depth;          // of the centre below the tangent plane
  Lanes along, cosine;  // components, along the child's normal, of the way from the centre to the place and of the
                        // place's normal
  Lanes excess;         // negative if the child is out of the cone or of the largest ball
};

// The child lies in the flat disc in which its ball and its slab meet, so this disc is tested:
// - Against the cone: its places q have f(q) = n (p - q) - sine |p - q| >= 0. This function is concave, so its tangent
//   at the disc's centre is above it, and the largest value of the tangent in the disc is an upper bound. It is the
//   slab that excludes the neighbourhood of p.
// - Against the largest ball, by the height of its centre p - r n above the slab and its way beside the child's ball.
Seen look_from(const TangentPlace& place, const SlabTree::Node& node, double radius) {
  const Point& p = place.position;
  const Vector& n = place.normal;
  const auto ux = node.normal.col(0), uy = node.normal.col(1), uz = node.normal.col(2);
  const Lanes x = p.x() - node.center.col(0), y = p.y() - node.center.col(1), z = p.z() - node.center.col(2);
  const Lanes& size = node.radius;
  Seen seen;
  seen.squared = x * x + y * y + z * z;
  seen.depth = n.x() * x + n.y() * y + n.z() * z;
  seen.along = ux * x + uy * y + uz * z;
  seen.cosine = n.x() * ux + n.y() * uy + n.z() * uz;

  const Lanes distance = seen.squared.sqrt(), part = place.sine / distance.max(std::numeric_limits<double>::min());
  const Lanes slope = part * seen.along - seen.cosine;
  const Lanes across2 = (part * x - n.x() - slope * ux).square() + (part * y - n.y() - slope * uy).square() +
                        (part * z - n.z() - slope * uz).square();
  const Lanes rise = (slope * node.low).max(slope * node.high) + across2.sqrt() * size;
  const Lanes in_cone = seen.depth - place.sine * distance + rise.min((across2 + slope.square()).sqrt() * size);

  const Lanes height = seen.along - radius * seen.cosine,
              apart2 = seen.squared - 2 * radius * seen.depth + radius * radius;
  const Lanes above = (height - node.high).max(node.low - height).max(0.0);
  const Lanes beside = ((apart2 - height.square()).max(0.0).sqrt() - size).max(0.0);
  const Lanes in_disc = radius * radius - above.square() - beside.square();
  const Lanes in_ball = (radius + size).square() - apart2;
  const Lanes margin = kMargin * (seen.squared + radius * radius);
  seen.excess = (in_disc.min(in_ball) + margin).min(in_cone + kMargin * (distance + size));
  return seen;
}

// An upper bound on the depth of the child's places below the tangent plane: by the child's ball alone, or by its slab
// along the slab's normal and by its ball across it.
double max_depth_of(const Seen& seen, const TangentPlace& place, const SlabTree::Node& node, Index i) {
  const double cosine = seen.cosine[i];
  const Vector across = place.normal - cosine * Vector(node.normal.row(i));
  const double by_slab = across.norm() * node.radius[i] - std::min(cosine * node.low[i], cosine * node.high[i]);
  return seen.depth[i] + std::min(by_slab, node.radius[i]);
}

double min_touch_of(const Seen& seen, const TangentPlace& place, const SlabTree::Node& node, Index i) {
  const double squared = seen.squared[i], size = node.radius[i], cosine = seen.cosine[i];
  const double depth = max_depth_of(seen, place, node, i);
  if (!(depth > 0)) return kInfinity;
  const double nearest = std::max(std::sqrt(squared) - size, 0.0);
  double bound = nearest * nearest / (2 * depth);
  if (nearest > 0) bound = std::max(bound, (squared - size * size) / (2 * (seen.depth[i] + size)));
  if (seen.along[i] > node.high[i] && 1 + cosine > 0)
    bound = std::max(bound, (seen.along[i] - node.high[i]) / (1 + cosine));
  if (seen.along[i] < node.low[i] && 1 - cosine > 0)
    bound = std::max(bound, (node.low[i] - seen.along[i]) / (1 - cosine));
  return bound;
}

// Whether all triangles of a child have normals with a larger component than `limit` along the place's normal, by the
// angles between both normals and that of the child.
bool faces_away(double cosine, double spread, double limit) {
  constexpr double kRounding = 1e-7;  // of sines from cosines
  if (!(cosine > -spread)) return false;
  const double sines = std::sqrt(std::max(1 - cosine * cosine, 0.0) * std::max(1 - spread * spread, 0.0));
  return cosine * spread - sines > limit + kRounding;
}

}  // namespace

SlabTree::Lanes SlabTree::min_touch(const Node& node, const TangentPlace& place, const Limits& limits) {
  const Seen seen = look_from(place, node, limits.radius);
  Lanes bounds = Lanes::Constant(kInfinity);
  for (Index i = 0; i < node.count; ++i) {
    if (seen.excess[i] < 0) continue;
    if (limits.cosine < 1 && faces_away(seen.cosine[i], node.spread[i], limits.cosine)) continue;
    bounds[i] = min_touch_of(seen, place, node, i);
  }
  return bounds;
}

SlabTree::Lanes SlabTree::min_ray(const Node& node, const TangentPlace& place, const Limits& limits) {
  Lanes bounds = Lanes::Constant(kInfinity);
  for (Index i = 0; i < node.count; ++i) {
    const Vector way = place.position - Point(node.center.row(i));
    const double depth = place.normal.dot(way), squared = way.squaredNorm(), size2 = node.radius[i] * node.radius[i];
    const double inside = depth * depth - squared + size2;
    if (squared <= size2) bounds[i] = 0;
    if (squared <= size2 || depth < 0 || inside < -kMargin * squared) continue;
    const double bound = (depth - std::sqrt(std::max(inside, 0.0))) / 2;
    if (bound < limits.radius) bounds[i] = bound;
  }
  return bounds;
}

}  // namespace orchard::detail
