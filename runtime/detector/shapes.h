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
  half_space  // the points of `half`; no pose moves it
};

// All points with normal . point <= offset. The normal is a unit vector.
struct HalfSpace {
  Vec3 normal{1, 0, 0};
  double offset = 0;
};

// A shape of any kind, in its own frame. Which members are used depends on the kind.
struct Shape {
  ShapeKind kind = ShapeKind::tree;
  HalfSpace half;
  PackedSphereTree own;        // the memory of `tree`, unless the application owns that
  TreeView tree;               // the surface; for a round shape its segment, for sweeps
  PreparedTree prepared;       // `tree`, prepared for queries
  Vec3 p{}, q{};               // round: the ends of the segment; box: p has half of each side length, not rounded
  double radius = 0;           // round
  Vec3 center{};               // the centre of a sphere around the shape
  double reach = 0;            // the radius of that sphere
  Vec3 box_low{}, box_high{};  // a box around the triangles, along the axes of the frame; not set for round shapes
  std::vector<Vec3> pieces;    // tree, box: one vertex of each connected piece of the surface
  std::vector<std::uint32_t> piece_vertices;  // tree: the indices of these vertices
  bool has_tree() const noexcept { return kind == ShapeKind::tree || kind == ShapeKind::box; }
};

// The shapes of a detector. The references to them stay valid when others are added. The functions that add a shape
// return kNoShape if it is not valid.
class ShapeTable {
 public:
  ShapeId add_tree(const TreeView& tree);
  ShapeId add_tree(PackedSphereTree&& tree);
  ShapeId add_round(const Vec3& p, const Vec3& q, double radius);
  ShapeId add_box(const Vec3& half_lengths);

  std::size_t size() const noexcept { return shapes_.size(); }
  bool contains(ShapeId shape) const noexcept { return shape < shapes_.size(); }
  const Shape& operator[](ShapeId shape) const noexcept { return shapes_[shape]; }
  void changed(ShapeId shape) noexcept;  // call it after the vertices of its tree have moved
  std::size_t memory_bytes() const noexcept;

 private:
  static void describe(Shape& shape);
  ShapeId add(Shape&& shape);
  std::deque<Shape> shapes_;
};

// Returns the distance of a point, in the shape's frame, from the box around the triangles or from a round shape;
// inside of a round shape, it is negative.
double distance_to_bounds(const Shape& shape, const Vec3& point) noexcept;

// Returns the point of the segment from p to q that is nearest to `to`.
inline Vec3 nearest_of_segment(const Vec3& p, const Vec3& q, const Vec3& to) noexcept {
  const Vec3 d = q - p;
  const double square = dot(d, d);
  return square > 0 ? p + std::clamp(dot(to - p, d) / square, 0.0, 1.0) * d : p;
}

// Returns the least t in [0, to] for which origin + t way is in the box; infinity if there is none.
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

// Returns the pose of a part in the world, from that of its body and from its pose in the body. Each of these may be
// off by kRigidTolerance, and their product by more, which is corrected. If one of them is not rigid, neither is the
// result.
Pose placed(const Pose& body, const Pose& local) noexcept;

}  // namespace orchard::runtime::detail
