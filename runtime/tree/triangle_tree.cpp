// One file: the builder is one pass down the tree, and what it measures of a part of the triangles (extents, moments,
// balls, ball slabs) goes by the order that the pass itself makes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "orchard/runtime/packed_tree.h"
#include "tree/places_along.h"
#include "tree/principal_axes.h"

// The tree of triangles: cut in two along a principal direction, eight children a node, leaves of up to eight
// triangles. Where all leaves fit in one block (a box, a wall, a simple hull), triangles are few and large beside what
// comes near them, and leaves hold what is flat together instead: see split_few().
namespace orchard::runtime {
namespace {

using detail::axes_of, detail::cross, detail::dot, detail::minus, detail::Vec3;
using detail::PlaceAlong, detail::sort_along;

// To a float and back, through memory: where GCC 12 makes vectors of several such lines (-O2 and above) it leaves both
// conversions out, and a ball slab would be measured from another centre than the one that is stored.
double rounded(double value) {
  const volatile float stored = static_cast<float>(value);
  return double{stored};
}

// A unit vector rounded to float, or the x axis for one that has no direction.
Vec3 direction(const Vec3& v) {
  const double largest = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(largest > 0)) return {1, 0, 0};
  const Vec3 w = {v[0] / largest, v[1] / largest, v[2] / largest};
  const double length = std::sqrt(dot(w, w));
  Vec3 result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = rounded(w[i] / length);
  return result;
}

float above(double value) {  // at least `value`, rounding of a few operations in double included
  return std::nextafter(static_cast<float>(value * (1 + 1e-14)), std::numeric_limits<float>::infinity());
}

Vec3 along(const Vec3& from, const Vec3& way, double by) {
  return {from[0] + by * way[0], from[1] + by * way[1], from[2] + by * way[2]};
}

// As queries find it, in float.
Vec3 float_cross(const Vec3& p, const Vec3& q) {
  Vec3 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    result[i] = rounded(rounded(p[j] * q[k]) - rounded(p[k] * q[j]));
  }
  return result;
}

// Cosines and sines of the directions tried for a box within its first plane, an eighth of a quarter turn from each
// other: more make it hardly smaller. Written out, as libraries differ in last digits.
constexpr std::array<std::array<double, 2>, 8> kBoxTurns = {{{1, 0},
                                                             {0.9807852804032304, 0.19509032201612825},
                                                             {0.9238795325112867, 0.3826834323650898},
                                                             {0.8314696123025452, 0.5555702330196022},
                                                             {0.7071067811865476, 0.7071067811865476},
                                                             {0.5555702330196022, 0.8314696123025452},
                                                             {0.3826834323650898, 0.9238795325112867},
                                                             {0.19509032201612825, 0.9807852804032304}}};

// Levels below which parts are halved by number: 31 more are enough for every count, and kTriangleTreeDepthLimit is 64.
constexpr std::uint32_t kCostlyDepth = 32;

// A tree of at most so many triangles has room for all of its leaves in one block.
constexpr std::size_t kFew = std::size_t{kBlockWidth} * kBlockWidth;
// A cut of few triangles is worth a leaf if the boxes of both parts, times their triangles, are less than this share of
// the whole part's. A smaller share would end too soon: of the four sides of a box, no single one is worth it.
constexpr double kWorthCutting = 1 - 1e-3;

struct Range {
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

// A range and what is measured of it, once.
struct Part : Range {
  Vec3 middle{};
  double radius = 0;           // of a small ball around the middle
  std::array<Vec3, 3> axes{};  // principal ones of the corners, the longest first
};

// A triangle as the order has it: what the loops over a part read lies side by side.
struct Triangle {
  std::array<std::array<float, 3>, 3> corners;
  std::uint32_t number;
};

struct BallSlab {
  Vec3 center, normal;
  double radius, height;
  Vec3 second, third;  // normals of the box
  double width, length;
};

class Builder {
 public:
  explicit Builder(PackedSphereTree& tree) : tree_(tree) {
    order_.resize(tree.triangles.size());
    centroids_.resize(order_.size());
    for (std::size_t t = 0; t < order_.size(); ++t) {
      order_[t].number = static_cast<std::uint32_t>(t);
      Vec3& sum = centroids_[t];
      for (std::size_t k = 0; k < 3; ++k) {
        order_[t].corners[k] = tree.vertices[tree.triangles[t][k]];
        for (std::size_t i = 0; i < 3; ++i) sum[i] += double{order_[t].corners[k][i]} / 3;
      }
    }
    if (is_few()) find_frames();
  }

  void build() {
    tree_.ball_slabs.clear();
    tree_.triangle_blocks.clear();
    tree_.triangle_tree_depth = 0;
    if (order_.empty()) return;
    std::vector<Part> level = {measured({0, order_.size()})}, next;
    add_block();
    place(0, 0, level[0]);
    std::vector<std::pair<std::size_t, std::uint32_t>> places = {{0, 0}}, next_places;
    for (; !level.empty(); ++tree_.triangle_tree_depth) {
      next.clear(), next_places.clear();
      for (std::size_t n = 0; n < level.size(); ++n) expand(level[n], places[n], next, next_places);
      level.swap(next), places.swap(next_places);
    }
    --tree_.triangle_tree_depth;
  }

 private:
  void add_block() { tree_.ball_slabs.emplace_back().radius.fill(-1); }

  void expand(const Part& node, const std::pair<std::size_t, std::uint32_t>& at, std::vector<Part>& next,
              std::vector<std::pair<std::size_t, std::uint32_t>>& next_places) {
    const bool divided = node.size() > kBlockWidth || (is_few() && tree_.triangle_tree_depth == 0);
    const std::vector<Part> parts = !divided ? std::vector<Part>() : is_few() ? split_few(node) : split(node);
    std::uint32_t& child = tree_.ball_slabs[at.first].child[at.second];
    if (parts.size() <= 1) {
      child = kLeafBit | static_cast<std::uint32_t>(tree_.triangle_blocks.size());
      add_triangles(node);
      return;
    }
    const std::size_t block = tree_.ball_slabs.size();
    child = static_cast<std::uint32_t>(block);
    add_block();
    for (std::uint32_t lane = 0; lane < parts.size(); ++lane) {
      place(block, lane, parts[lane]);
      next.push_back(parts[lane]);
      next_places.emplace_back(block, lane);
    }
  }

  void add_triangles(const Range& leaf) {
    TriangleBlock& block = tree_.triangle_blocks.emplace_back();
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      const bool used = lane < leaf.size();
      const Triangle& t = order_[leaf.begin + (used ? lane : 0)];
      block.triangle[lane] = used ? t.number : kNoTriangle;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) block.corner[k][i][lane] = t.corners[k][i];
      }
    }
  }

  // Halves the widest part until there are eight; what fits a leaf stays whole.
  std::vector<Part> split(const Part& node) {
    std::vector<Part> parts = {node};
    std::vector<double> widths = {1};
    while (parts.size() < kBlockWidth) {
      const auto widest = static_cast<std::size_t>(std::max_element(widths.begin(), widths.end()) - widths.begin());
      if (widths[widest] < 0) break;
      const Part whole = parts[widest];
      const std::size_t middle = halve(whole);
      parts[widest] = measured({whole.begin, middle});
      const auto behind = static_cast<std::ptrdiff_t>(widest) + 1;
      parts.insert(parts.begin() + behind, measured({middle, whole.end}));
      widths[widest] = width_of(parts[widest]);
      widths.insert(widths.begin() + behind, width_of(parts[widest + 1]));
    }
    return parts;
  }

  static double width_of(const Part& part) { return part.size() <= kBlockWidth ? -1 : part.radius; }

  struct Extent {
    Vec3 low, high;  // along the part's principal axes
    void add(const Extent& other) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], other.low[i]), high[i] = std::max(high[i], other.high[i]);
      }
    }
    double area() const {
      const Vec3 e = minus(high, low);
      return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
    }
  };
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr Extent kNothing = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

  static Extent extent_of(const Triangle& triangle, const std::array<Vec3, 3>& axes) {
    Extent extent = kNothing;
    for (const auto& corner : triangle.corners) {
      const Vec3 p = as_doubles(corner), along = {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
      extent.add({along, along});
    }
    return extent;
  }
  static Vec3 as_doubles(const std::array<float, 3>& p) { return {double{p[0]}, double{p[1]}, double{p[2]}}; }

  static std::size_t multiple_of_width(std::size_t count) {
    return (count + kBlockWidth - 1) / kBlockWidth * kBlockWidth;
  }

  // The cheapest first, and of equal ones the more even one.
  struct Cut {
    double cost = kInfinity;
    std::size_t unevenness = 0, frame = 0, axis = 0, at = 0;
    double gain = 0;     // over no cut; of few triangles
    bool worth = false;  // a leaf of its own; of few triangles
    bool operator<(const Cut& other) const {
      return std::tie(cost, unevenness, frame, axis, at) <
             std::tie(other.cost, other.unevenness, other.frame, other.axis, other.at);
    }
  };

  // Across a principal axis, where the boxes of the two parts, times their triangles, are smallest (MacDonald and Booth
  // 1990), the more even parts of equal ones; far down in half, which limits the depth. At a multiple of eight
  // triangles, so that leaves are full.
  std::size_t halve(const Part& part) {
    const std::size_t half = multiple_of_width(part.size() / 2);
    if (tree_.triangle_tree_depth >= kCostlyDepth) {
      find_places(part, part.axes[0], 0);
      put_in_order(places_[0], part);
      return part.begin + half;
    }
    Cut best = {.at = half};
    find_cut(part, part.axes, 0, half, kBlockWidth, best);
    put_in_order(places_[best.axis], part);
    return part.begin + best.at;
  }

  // The cheapest cut across any of three axes at a multiple of `step` triangles, if it is better than `best`.
  void find_cut(const Part& part, const std::array<Vec3, 3>& axes, std::size_t frame, std::size_t half,
                std::size_t step, Cut& best) {
    const std::size_t size = part.size();
    extents_.resize(size);
    for (std::size_t i = 0; i < size; ++i) extents_[i] = extent_of(order_[part.begin + i], axes);
    behind_.resize(size);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      find_places(part, axes[axis], axis);
      const std::vector<PlaceAlong>& places = places_[axis];
      Extent extent = kNothing;
      for (std::size_t i = size; i-- > 0;) {
        extent.add(extents_[places[i].from]);
        if (i % step == 0) behind_[i] = extent.area() * static_cast<double>(size - i);
      }
      extent = kNothing;
      for (std::size_t i = 0; i < size; ++i) {
        if (i > 0 && i % step == 0) {
          const double cost = extent.area() * static_cast<double>(i) + behind_[i];
          best = std::min(best, Cut{cost, i > half ? i - half : half - i, frame, axis, i});
        }
        extent.add(extents_[places[i].from]);
      }
    }
  }

  // Where the centroids are along an axis, in their order; equal ones go by their triangles' numbers.
  void find_places(const Part& part, const Vec3& along, std::size_t axis) {
    std::vector<PlaceAlong>& places = places_[axis];
    places.resize(part.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t number = order_[part.begin + i].number;
      places[i] = {dot(along, centroids_[number]), number, static_cast<std::uint32_t>(i)};
    }
    sort_along(places, sorted_);
  }
  void put_in_order(const std::vector<PlaceAlong>& places, const Range& part) {
    before_.assign(order_.begin() + static_cast<std::ptrdiff_t>(part.begin),
                   order_.begin() + static_cast<std::ptrdiff_t>(part.end));
    for (std::size_t i = 0; i < places.size(); ++i) order_[part.begin + i] = before_[places[i].from];
  }

  bool is_few() const { return order_.size() <= kFew; }

  // Axes that boxes of few triangles may have: those of the coordinates, and of the largest triangles that differ in
  // them, across the triangle and along its shortest edge. Principal axes of few corners are tilted against all faces.
  void find_frames() {
    constexpr std::size_t kMaxFrames = 8;
    frames_ = {{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
    std::vector<std::pair<double, std::array<Vec3, 3>>> faces;
    for (const Triangle& t : order_) {
      std::array<Vec3, 3> edges{};
      for (std::size_t k = 0; k < 3; ++k)
        edges[k] = minus(as_doubles(t.corners[(k + 1) % 3]), as_doubles(t.corners[k]));
      const Vec3 across = cross(edges[0], edges[1]);
      const Vec3 shortest = *std::min_element(edges.begin(), edges.end(),
                                              [](const Vec3& p, const Vec3& q) { return dot(p, p) < dot(q, q); });
      if (!(dot(across, across) > 0)) continue;
      const Vec3 n = unit(across), e = unit(shortest);
      faces.push_back({-dot(across, across), {n, e, cross(n, e)}});
    }
    std::stable_sort(faces.begin(), faces.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    for (const auto& face : faces) {
      if (frames_.size() == kMaxFrames) break;
      const auto same = [&](const std::array<Vec3, 3>& frame) { return are_same(frame, face.second); };
      if (std::none_of(frames_.begin(), frames_.end(), same)) frames_.push_back(face.second);
    }
  }

  static Vec3 unit(const Vec3& v) {
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
  }

  // Whether each axis of one is an axis of the other, nearly, whatever their order and signs.
  static bool are_same(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
    constexpr double kNearlyOne = 1 - 1e-12;
    return std::all_of(p.begin(), p.end(), [&](const Vec3& u) {
      return std::any_of(q.begin(), q.end(), [&](const Vec3& v) { return std::fabs(dot(u, v)) > kNearlyOne; });
    });
  }

  Extent extent_of(const Range& part, const std::array<Vec3, 3>& axes) const {
    Extent extent = kNothing;
    for (std::size_t i = part.begin; i < part.end; ++i) extent.add(extent_of(order_[i], axes));
    return extent;
  }

  Cut cut_of_few(const Part& part) {
    Cut best;
    double area = kInfinity;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      area = std::min(area, extent_of(part, frames_[f]).area());
      find_cut(part, frames_[f], f, part.size() / 2, 1, best);
    }
    const double whole = area * static_cast<double>(part.size());
    best.gain = whole - best.cost;
    best.worth = part.size() > kBlockWidth || best.cost < kWorthCutting * whole;
    return best;
  }

  // Cuts what gains most by it, until there are eight parts or no cut is worth it: leaves need not be full, for all of
  // them fit in the block.
  std::vector<Part> split_few(const Part& node) {
    std::vector<Part> parts = {node};
    std::vector<Cut> cuts = {cut_of_few(node)};
    while (parts.size() < kBlockWidth) {
      std::size_t best = parts.size();
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (cuts[i].worth && (best == parts.size() || cuts[i].gain > cuts[best].gain)) best = i;
      }
      if (best == parts.size()) break;
      const Part whole = parts[best];
      find_places(whole, frames_[cuts[best].frame][cuts[best].axis], 0);
      put_in_order(places_[0], whole);
      const auto behind = static_cast<std::ptrdiff_t>(best) + 1;
      parts[best] = measured({whole.begin, whole.begin + cuts[best].at});
      parts.insert(parts.begin() + behind, measured({whole.begin + cuts[best].at, whole.end}));
      cuts[best] = cut_of_few(parts[best]);
      cuts.insert(cuts.begin() + behind, cut_of_few(parts[best + 1]));
    }
    return parts;
  }

  Part measured(const Range& range) const {
    Part part;
    static_cast<Range&>(part) = range;
    find_ball(part);
    part.axes = axes_of(covariance(part));
    return part;
  }

  // Of the corners, scaled to be free of overflow.
  std::array<double, 6> covariance(const Part& part) const {
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

  template <typename Visit>
  void each_corner(const Range& part, Visit&& visit) const {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      for (const auto& corner : order_[i].corners) visit(as_doubles(corner));
    }
  }

  // A small ball (Ritter's): from a long chord, grown to reach every corner.
  void find_ball(Part& part) const {
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

  // Between the planes across `normal`, centred between them.
  BallSlab ball_slab_across(const Range& part, const Vec3& middle, const Vec3& normal) const {
    double low = kInfinity, high = -kInfinity;
    each_corner(part, [&](const Vec3& p) {
      const double h = dot(normal, minus(p, middle));
      low = std::min(low, h), high = std::max(high, h);
    });
    BallSlab slab{};
    slab.normal = normal;
    slab.center = along(middle, normal, (low + high) / 2);
    slab.height = (high - low) / 2;
    return slab;
  }

  // The flatter one of the ball slab across the corners' thinnest direction and the one along the surface's mean
  // normal.
  BallSlab ball_slab_of(const Part& part) {
    Vec3 mean{};
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const auto& corners = order_[i].corners;
      const Vec3 a = as_doubles(corners[0]);
      const Vec3 n = cross(minus(as_doubles(corners[1]), a), minus(as_doubles(corners[2]), a));
      for (std::size_t k = 0; k < 3; ++k) mean[k] += n[k];
    }
    const BallSlab thin = ball_slab_across(part, part.middle, direction(part.axes[2]));
    const BallSlab facing = ball_slab_across(part, part.middle, direction(mean));
    BallSlab slab = facing.height <= thin.height ? facing : thin;
    find_box(part, slab);
    return slab;
  }

  // The other two pairs of planes: across the directions, among a few, that make the smallest box, which is centred
  // between all of them. Everything is measured last, from what is stored.
  void find_box(const Range& part, BallSlab& slab) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (std::fabs(slab.normal[i]) < std::fabs(slab.normal[least])) least = i;
    }
    Vec3 axis{};
    axis[least] = 1;
    const Vec3 u = direction(cross(slab.normal, axis)), v = cross(slab.normal, u);
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
    if (is_few()) take_smaller_frame(part, smallest, slab);
    measure_box(part, slab);
  }

  // The axes of one of the frames in place of those found, if the box is smaller then; the thinnest way comes first.
  void take_smaller_frame(const Range& part, double smallest, BallSlab& slab) const {
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

  void measure_box(const Range& part, BallSlab& slab) const {
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

  void place(std::size_t block_index, std::uint32_t lane, const Part& part) {
    const BallSlab slab = ball_slab_of(part);
    BallSlabBlock& block = tree_.ball_slabs[block_index];
    block.x[lane] = static_cast<float>(slab.center[0]);
    block.y[lane] = static_cast<float>(slab.center[1]);
    block.z[lane] = static_cast<float>(slab.center[2]);
    block.nx[lane] = static_cast<float>(slab.normal[0]);
    block.ny[lane] = static_cast<float>(slab.normal[1]);
    block.nz[lane] = static_cast<float>(slab.normal[2]);
    block.mx[lane] = static_cast<float>(slab.second[0]);
    block.my[lane] = static_cast<float>(slab.second[1]);
    block.mz[lane] = static_cast<float>(slab.second[2]);
    block.radius[lane] = above(slab.radius);
    // What cancels in a height is of the size of the distances from the centre.
    block.height[lane] = above(slab.height + 1e-15 * slab.radius);
    block.width[lane] = above(slab.width + 1e-15 * slab.radius);
    block.length[lane] = above(slab.length + 1e-15 * slab.radius);
  }

  PackedSphereTree& tree_;
  std::vector<Triangle> order_;
  std::vector<Vec3> centroids_;  // by the triangles' numbers
  // While a part is halved:
  std::vector<Triangle> before_;  // as it was ordered
  std::vector<Extent> extents_;   // of its triangles
  std::vector<double> behind_;    // what a cut costs behind it
  std::array<std::vector<PlaceAlong>, 3> places_;
  std::vector<PlaceAlong> sorted_;
  std::vector<std::array<double, 2>> across_;  // corners, while a box is looked for
  std::vector<std::array<Vec3, 3>> frames_;    // of few triangles: find_frames()
};

}  // namespace

void index_triangles(PackedSphereTree& tree) {
  Builder(tree).build();
  tree.supports.clear();
  if (tree.triangles.empty()) return;
  std::vector<bool> used(tree.vertices.size());
  for (const auto& triangle : tree.triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  }
  std::array<double, kSupportCount> most;
  most.fill(-std::numeric_limits<double>::infinity());
  std::array<Vec3, kSupportCount> directions;
  for (std::uint32_t i = 0; i < kSupportCount; ++i) directions[i] = support_direction(i);
  double largest = 0;
  for (std::size_t v = 0; v < tree.vertices.size(); ++v) {
    if (!used[v]) continue;
    const Vec3 p = {double{tree.vertices[v][0]}, double{tree.vertices[v][1]}, double{tree.vertices[v][2]}};
    largest = std::max({largest, std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
    for (std::size_t i = 0; i < kSupportCount; ++i) most[i] = std::max(most[i], dot(directions[i], p));
  }
  for (const double reach : most) {
    const double above_all = reach + 1e-15 * 3 * largest;  // the sum's rounding
    tree.supports.push_back(std::nextafter(static_cast<float>(above_all), std::numeric_limits<float>::infinity()));
  }
}

}  // namespace orchard::runtime
