#include "tree/box_fitter.h"

#include "tree/principal_axes.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Rounds a number to float, through memory. When GCC 12 makes vectors of several such lines (-O2 and above), it omits
// both conversions, and a ball slab would be measured from another centre than the one that is stored.
double rounded(double value) {
  const volatile float stored = static_cast<float>(value);
  return double{stored};
}

// Returns the unit vector along v rounded to float, or the x axis if v has no direction.
Vec3 direction(const Vec3& v) {
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(largest > 0)) return {1, 0, 0};
  const Vec3 w = {v[0] / largest, v[1] / largest, v[2] / largest};
  const double length = std::sqrt(dot(w, w));
  Vec3 result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = rounded(w[i] / length);
  return result;
}

// Returns the cross product as queries compute it, in float.
Vec3 float_cross(const Vec3& p, const Vec3& q) {
  Vec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    result[i] = rounded(rounded(p[j] * q[k]) - rounded(p[k] * q[j]));
  }
  return result;
}

// Cosines and sines of the directions that are tried for a box within its first plane, an eighth of a quarter turn
// apart. More directions make it hardly smaller. The values are written out because libraries differ in the last
// digits.
constexpr std::array<std::array<double, 2>, 8> kBoxTurns = {{{1, 0},
                                                             {0.9807852804032304, 0.19509032201612825},
                                                             {0.9238795325112867, 0.3826834323650898},
                                                             {0.8314696123025452, 0.5555702330196022},
                                                             {0.7071067811865476, 0.7071067811865476},
                                                             {0.5555702330196022, 0.8314696123025452},
                                                             {0.3826834323650898, 0.9238795325112867},
                                                             {0.19509032201612825, 0.9807852804032304}}};

}  // namespace

Extent Extent::of(const Triangle& triangle, const std::array<Vec3, 3>& axes) noexcept {
  Extent extent;
  for (const auto& corner : triangle.corners) {
    const Vec3 p = as_doubles(corner), place = {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
    extent.add({place, place});
  }
  return extent;
}

Extent BoxFitter::extent_of(const Range& part, const std::array<Vec3, 3>& axes) const noexcept {
  Extent extent;
  for (std::size_t i = part.begin; i < part.end; ++i) extent.add(Extent::of(order_[i], axes));
  return extent;
}

Part BoxFitter::measured(const Range& range) const {
  Part part;
  static_cast<Range&>(part) = range;
  find_ball(part);
  part.axes = axes_of(covariance(part));
  return part;
}

// Returns the covariance of the corners up to a factor, scaled so that nothing overflows.
std::array<double, 6> BoxFitter::covariance(const Part& part) const {
  std::array<double, 6> m{};
  if (!(part.radius > 0)) return m;
  Vec3 mean{};
  const double share = 1 / (3 * static_cast<double>(part.size()));
  each_corner(part, [&](const Vec3& p) {
    for (std::size_t i = 0; i < 3; ++i) mean[i] += (p[i] - part.middle[i]) / part.radius * share;
  });
  each_corner(part, [&](const Vec3& p) {
    Vec3 d = minus(p, part.middle);
    for (std::size_t i = 0; i < 3; ++i) d[i] = d[i] / part.radius - mean[i];
    m[0] += d[0] * d[0], m[1] += d[1] * d[1], m[2] += d[2] * d[2];
    m[3] += d[0] * d[1], m[4] += d[0] * d[2], m[5] += d[1] * d[2];
  });
  return m;
}

// Finds a small ball by Ritter's algorithm: the ball around a long chord grows until it contains every corner.
void BoxFitter::find_ball(Part& part) const {
  const auto farthest = [&](const Vec3& from) {
    Vec3 best = from;
    double most = -1;
    each_corner(part, [&](const Vec3& p) {
      const Vec3 d = minus(p, from);
      if (dot(d, d) > most) most = dot(d, d), best = p;
    });
    return best;
  };
  const Vec3 p = farthest(as_doubles(order_[part.begin].corners[0])), q = farthest(p), chord = minus(q, p);
  Vec3 center = {(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2};
  double radius = std::sqrt(dot(chord, chord)) / 2;
  each_corner(part, [&](const Vec3& x) {
    const Vec3 d = minus(x, center);
    const double distance = std::sqrt(dot(d, d));
    if (distance <= radius) return;
    const double grown = (radius + distance) / 2;
    for (std::size_t i = 0; i < 3; ++i) center[i] += d[i] * ((grown - radius) / distance);
    radius = grown;
  });
  part.middle = center;
  part.radius = radius;
}

// Returns the part's ball slab with the normal `normal`, without its radius. Its centre is halfway between its planes.
ObbNode BoxFitter::obb_node_across(const Range& part, const Vec3& middle, const Vec3& normal) const {
  double low = kInfinity, high = -kInfinity;
  each_corner(part, [&](const Vec3& p) {
    const double h = dot(normal, minus(p, middle));
    low = std::min(low, h), high = std::max(high, h);
  });
  return {.center = along(middle, normal, (low + high) / 2), .normal = normal, .radius = 0, .height = (high - low) / 2};
}

// Starts with the flatter one of two ball slabs, across the corners' thinnest direction and across the surface's mean
// normal, and makes it a box.
ObbNode BoxFitter::obb_node_of(const Part& part) {
  Vec3 mean{};
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const auto& corners = order_[i].corners;
    const Vec3 a = as_doubles(corners[0]);
    const Vec3 n = cross(minus(as_doubles(corners[1]), a), minus(as_doubles(corners[2]), a));
    for (std::size_t k = 0; k < 3; ++k) mean[k] += n[k];
  }
  const ObbNode thin = obb_node_across(part, part.middle, direction(part.axes[2]));
  const ObbNode facing = obb_node_across(part, part.middle, direction(mean));
  ObbNode slab = facing.height <= thin.height ? facing : thin;
  find_box(part, slab);
  return slab;
}

// Adds the other two pairs of planes, across those of a few directions that make the smallest box, and centres the box
// between all planes. All sizes are measured at the end, from the values that are stored.
void BoxFitter::find_box(const Range& part, ObbNode& slab) {
  const Vec3 u = direction(cross(slab.normal, least_axis(slab.normal))), v = cross(slab.normal, u);
  across_.clear();
  each_corner(part, [&](const Vec3& p) {
    const Vec3 d = minus(p, slab.center);
    across_.push_back({dot(u, d), dot(v, d)});
  });
  std::array<double, 2> turn{}, middle{};
  double smallest = kInfinity;
  for (const auto& [c, s] : kBoxTurns) {
    std::array<double, 2> low = {kInfinity, kInfinity}, high = {-kInfinity, -kInfinity};
    for (const auto& [x, y] : across_) {
      const double p = c * x + s * y, q = c * y - s * x;
      low = {std::min(low[0], p), std::min(low[1], q)}, high = {std::max(high[0], p), std::max(high[1], q)};
    }
    const double width = high[0] - low[0], length = high[1] - low[1];
    const double area = width * length + 2 * slab.height * (width + length);
    if (area >= smallest) continue;
    smallest = area;
    turn = {c, s}, middle = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
  }
  const auto in_plane = [&](double x, double y) { return along(along({}, u, x), v, y); };
  const Vec3 second = in_plane(turn[0], turn[1]), third = in_plane(-turn[1], turn[0]);
  slab.center = along(along(slab.center, second, middle[0]), third, middle[1]);
  slab.second = direction(second);
  take_smaller_frame(part, smallest, slab);
  measure_box(part, slab);
}

// Replaces the axes by those of the frame with the smallest box, if this is smaller than `smallest`, the area of the
// box so far. The axis along which the box is thinnest comes first.
void BoxFitter::take_smaller_frame(const Range& part, double smallest, ObbNode& slab) const {
  for (const std::array<Vec3, 3>& frame : frames_) {
    const Extent extent = extent_of(part, frame);
    const Vec3 e = minus(extent.high, extent.low);
    if (!(extent.area() < smallest)) continue;
    smallest = extent.area();
    std::array<std::size_t, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&e](std::size_t i, std::size_t k) { return e[i] < e[k]; });
    slab.normal = direction(frame[order[0]]);
    slab.second = direction(frame[order[1]]);
    slab.center = {};
    for (std::size_t i = 0; i < 3; ++i) {
      slab.center = along(slab.center, frame[i], (extent.low[i] + extent.high[i]) / 2);
    }
  }
}

void BoxFitter::measure_box(const Range& part, ObbNode& slab) const {
  for (double& x : slab.center) x = rounded(x);
  slab.third = float_cross(slab.normal, slab.second);
  slab.radius = slab.height = slab.width = slab.length = 0;
  each_corner(part, [&](const Vec3& p) {
    const Vec3 d = minus(p, slab.center);
    slab.radius = std::max(slab.radius, std::sqrt(dot(d, d)));
    slab.height = std::max(slab.height, std::fabs(dot(slab.normal, d)));
    slab.width = std::max(slab.width, std::fabs(dot(slab.second, d)));
    slab.length = std::max(slab.length, std::fabs(dot(slab.third, d)));
  });
}

}  // namespace orchard::runtime::detail
