#pragma once
#include <algorithm>
#include <deque>
#include <limits>
#include <memory>
#include <vector>

#include "orchard/runtime/detector.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum class ShapeKind : std::uint8_t {
  tree,
  round,      // a sphere or a capsule: the points within `radius` of the segment from p to q
  box,        // a tree of twelve triangles, and solid
  half_space  // `half`, which no pose moves, and nothing below it
};

// Everything with normal . point <= offset; the normal is a unit vector.
struct HalfSpace {
  Vec3 normal{1, 0, 0};
  double offset = 0;
};

struct Shape {
  ShapeKind kind = ShapeKind::tree;
  HalfSpace half;
  PackedSphereTree own;        // what `tree` views, if it is that of a box, of a round shape's segment, or of a file
  TreeView tree;               // the surface; of a round shape the segment, for sweeps
  PreparedTree prepared;       // the same
  Vec3 p{}, q{};               // of a box: p is half of its lengths, which its tree has rounded up to floats
  double radius = 0;           // of round shapes
  Vec3 center{};               // of a sphere around the shape,
  double reach = 0;            // and its radius
  Vec3 box_low{}, box_high{};  // of a box around the triangles, by the shape's axes; not of round shapes
  std::vector<Vec3> pieces;    // of a tree: a vertex of each connected piece of its surface,
  std::vector<std::uint32_t> piece_vertices;  // and which these are
  bool has_tree() const noexcept { return kind == ShapeKind::tree || kind == ShapeKind::box; }
};

// Shapes stay where they are.
class ShapeTable {
 public:
  ShapeId add_tree(const TreeView& tree);
  ShapeId add_tree(PackedSphereTree&& tree);
  ShapeId add_round(const Vec3& p, const Vec3& q, double radius);
  ShapeId add_box(const Vec3& half_lengths);

  std::size_t size() const noexcept { return shapes_.size(); }
  bool contains(ShapeId shape) const noexcept { return shape < shapes_.size(); }
  const Shape& operator[](ShapeId shape) const noexcept { return shapes_[shape]; }
  void changed(ShapeId shape) noexcept;  // the places of its tree's vertices
  std::size_t memory_bytes() const noexcept;

 private:
  static void describe(Shape& shape);
  ShapeId add(Shape&& shape);
  std::deque<Shape> shapes_;
};

// How far a point in the shape's frame is from the box around it, or from the segment of a round shape less its radius.
double distance_to_bounds(const Shape& shape, const Vec3& point) noexcept;

inline Vec3 nearest_of_segment(const Vec3& p, const Vec3& q, const Vec3& to) noexcept {
  const Vec3 d = q - p;
  const double square = dot(d, d);
  return square > 0 ? p + std::clamp(dot(to - p, d) / square, 0.0, 1.0) * d : p;
}

// When origin + t way, 0 <= t <= to, enters a box; infinite: it does not.
inline double enters_box(const Vec3& low, const Vec3& high, const Vec3& origin, const Vec3& way, double to) noexcept {
  double from = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (way[i] == 0) {
      if (origin[i] < low[i] || origin[i] > high[i]) return kInfinity;
      continue;
    }
    const double p = (low[i] - origin[i]) / way[i], q = (high[i] - origin[i]) / way[i];
    from = std::max(from, std::min(p, q)), to = std::min(to, std::max(p, q));
  }
  return from <= to ? from : kInfinity;
}

// `local` in `body`: each may be off by kRigidTolerance, and together by more. What is not rigid stays so.
Pose placed(const Pose& body, const Pose& local) noexcept;

}  // namespace orchard::runtime::detail
