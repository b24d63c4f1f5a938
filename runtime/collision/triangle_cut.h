#pragma once
#include <array>
#include <cstddef>

#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

struct Segment3 {
  Vec3 p, q;
};

// What two triangles have in common, which triangles_intersect() says they have: the ends of the common segment, or
// two points far apart of the common part of triangles in one plane; correct up to rounding. `witness`: a common point,
// for the case that rounding leaves nothing else.
Segment3 common_segment(const TrianglePoints& a, const TrianglePoints& b, const Vec3& witness) noexcept;

// A direction and two across it, all of length 1.
struct Way {
  Vec3 u, e, f;
  explicit Way(const Vec3& direction) noexcept;
};

// How far b can move along a way and still meet a: the largest t with a and b + t u sharing a point, up to rounding,
// and the unit normal of what they meet in there, pointing along u. `t` is minus infinity where they meet for no t.
struct Exit {
  double t;
  Vec3 normal;
};
Exit exit_along(const TrianglePoints& a, const TrianglePoints& b, const Way& way) noexcept;

// Whether a plane across a normal of the triangles or across two of their edges parts them by more than `gap`, up to
// rounding. Such a plane is all but sure to be found where they are that far apart.
bool are_parted_by(const TrianglePoints& a, const TrianglePoints& b, double gap) noexcept;

// All shifts of b that leave it meeting a, for two triangles that meet: a convex set, between the planes across the
// triangles' normals and across pairs of their edges. Tells for any direction at once how far the triangles stay in
// contact, an order faster than exit_along() does, up to rounding.
class MeetingShifts {
 public:
  MeetingShifts() = default;
  MeetingShifts(const TrianglePoints& a, const TrianglePoints& b) noexcept;

  // Whether b meets a all the way to t * direction. False where the set is flat: nothing is known there.
  bool contain(const Vec3& direction, double t) const noexcept;
  // The shortest shift that leads out, nearly. 0 where the set is flat.
  const Vec3& shortest_way_out() const noexcept { return shortest_; }
  double shortest() const noexcept { return least_; }  // its length

 private:
  static constexpr std::size_t kNormals = 11;
  std::array<Vec3, kNormals> normals_;           // `count_` of them
  std::array<double, kNormals> ahead_, behind_;  // -behind <= normal . shift <= ahead
  std::size_t count_ = 0;
  Vec3 shortest_{};
  double least_ = 0;
};

}  // namespace orchard::runtime::detail
