#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "math/vector_functions.h"

// Small balls and boxes around given triangles, for the nodes of a triangle BVH. The results are deterministic.
namespace orchard::runtime::detail {

struct Range {
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

// A range of triangles, and measures of it that are computed once.
struct Part : Range {
  Vec3 middle{};
  double radius = 0;           // of a small ball around the middle
  std::array<Vec3, 3> axes{};  // the principal axes of the corners, the longest first
};

// A triangle in the order of the builder. What the loops over a part read lies side by side in memory.
struct Triangle {
  std::array<std::array<float, 3>, 3> corners;
  std::uint32_t number;
};

struct ObbNode {
  Vec3 center, normal;
  double radius, height;
  Vec3 second{}, third{};  // normals of the box
  double width = 0, length = 0;
};

inline Vec3 as_doubles(const std::array<float, 3>& p) noexcept { return {double{p[0]}, double{p[1]}, double{p[2]}}; }

// A box along three axes. It is empty at first.
struct Extent {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};

  static Extent of(const Triangle& triangle, const std::array<Vec3, 3>& axes) noexcept;
  void add(const Extent& other) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other.low[i]), high[i] = std::max(high[i], other.high[i]);
    }
  }
  double area() const noexcept {
    const Vec3 e = minus(high, low);
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
  }
};

// Fits balls and boxes around ranges of `order`. `frames` are further axes that boxes may have. Both are referred to,
// and may change later.
class BoxFitter {
 public:
  using Frames = std::vector<std::array<Vec3, 3>>;
  BoxFitter(const std::vector<Triangle>& order, const Frames& frames) noexcept : order_(order), frames_(frames) {}

  Part measured(const Range& range) const;
  ObbNode obb_node_of(const Part& part);
  Extent extent_of(const Range& part, const std::array<Vec3, 3>& axes) const noexcept;

 private:
  template <typename Visit>
  void each_corner(const Range& part, Visit&& visit) const {
    for (std::size_t i = part.begin; i < part.end; ++i) {
      for (const auto& corner : order_[i].corners) visit(as_doubles(corner));
    }
  }
  std::array<double, 6> covariance(const Part& part) const;
  void find_ball(Part& part) const;
  ObbNode obb_node_across(const Range& part, const Vec3& middle, const Vec3& normal) const;
  void find_box(const Range& part, ObbNode& slab);
  void take_smaller_frame(const Range& part, double smallest, ObbNode& slab) const;
  void measure_box(const Range& part, ObbNode& slab) const;

  const std::vector<Triangle>& order_;
  const Frames& frames_;
  std::vector<std::array<double, 2>> across_;  // the corners in the plane of the normal, while find_box() runs
};

}  // namespace orchard::runtime::detail
