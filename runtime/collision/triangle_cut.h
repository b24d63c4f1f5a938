#pragma once
#include <array>
#include <cstddef>

#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

struct Segment3 {
  Vec3 p, q;
};

// A direction and two across it, all of length 1.
struct Way {
  Vec3 u, e, f;
  explicit Way(const Vec3& direction) noexcept;
};

// Whether a plane across a normal of the triangles or across two of their edges parts them by more than `gap`, up to
// rounding. Such a plane is all but sure to be found where they are that far apart.
bool are_parted_by(const TrianglePoints& a, const TrianglePoints& b, double gap) noexcept;

// A pair of parallel planes that all shifts of b are between that leave it meeting a: -behind <= normal . shift <=
// ahead.
struct ShiftPlanes {
  Vec3 normal;  // of length 1 but for rounding
  double ahead, behind;

  // How far a shift can grow along a direction. `slack`: what rounding does to lengths.
  double exit(const Vec3& direction, double slack) const noexcept;
};

// Those across both triangles: 0 of a triangle without area.
std::array<ShiftPlanes, 2> face_planes(const TrianglePoints& a, const TrianglePoints& b) noexcept;

// What two triangles have in common, which triangles_intersect() says they have: the ends of the common segment, or
// two points far apart of the common part of triangles in one plane; correct up to rounding. `witness`: a common point,
// for the case that rounding leaves nothing else.
Segment3 common_segment(const TrianglePoints& a, const TrianglePoints& b, const std::array<ShiftPlanes, 2>& faces,
                        const Vec3& witness) noexcept;

// All shifts of b that leave it meeting a, for two triangles that meet: a convex set, between the planes across the
// triangles' normals and across pairs of their edges, up to rounding. The set is flat for triangles in one plane.
class MeetingShifts {
 public:
  MeetingShifts() = default;
  MeetingShifts(const TrianglePoints& a, const TrianglePoints& b) noexcept;

  // How far b can move along a direction and still meet a, and the normal of what they part at, pointing along it.
  struct Exit {
    double way;
    Vec3 normal;
  };
  // Where that is no more than `least`, any such way.
  Exit exit(const Vec3& direction, double least) const noexcept;
  // Whether b meets a all the way to t * direction. False where the set is flat.
  bool contain(const Vec3& direction, double t) const noexcept;
  // The shortest shift that leads out, nearly. 0 where the set is flat.
  Vec3 shortest_way_out() const noexcept;
  double shortest() const noexcept;  // its length

 private:
  static constexpr std::size_t kPlanes = 11;
  std::array<ShiftPlanes, kPlanes> planes_;  // `count_` of them
  std::size_t count_ = 0;
  double slack_ = 0;
  bool flat_ = false;
};

}  // namespace orchard::runtime::detail
