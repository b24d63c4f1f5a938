#pragma once
#include <array>
#include <cstddef>

#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

struct Segment3 {
  Vec3 p, q;
};

// A direction and two directions perpendicular to it, all of length 1.
struct Way {
  Vec3 u, e, f;
  explicit Way(const Vec3& direction) noexcept;
};

// Returns whether a plane separates two triangles by more than `gap`, up to rounding. The planes that are tried are
// perpendicular to a normal of a triangle, or to the cross product of two edges. If the triangles are so far apart,
// such a plane nearly always exists.
bool are_parted_by(const TrianglePoints& a, const TrianglePoints& b, double gap) noexcept;

// A pair of parallel planes. All shifts of b after which it meets a are between them: -behind <= normal . shift <=
// ahead.
struct ShiftPlanes {
  Vec3 normal;  // of length 1 up to rounding
  double ahead, behind;

  // Returns how far a shift along a direction can go until it leaves the planes. `slack` bounds the rounding of
  // lengths.
  double exit(const Vec3& direction, double slack) const noexcept;
};

// Returns the planes with the normals of both triangles; they are 0 for a triangle without area.
std::array<ShiftPlanes, 2> face_planes(const TrianglePoints& a, const TrianglePoints& b) noexcept;

// Returns the intersection of two triangles: the ends of the common segment or, for triangles in one plane, two points
// of the common part that are far apart. It is correct up to rounding. `witness` is a common point, which is the result
// if rounding leaves nothing else. Precondition: triangles_intersect() is true.
Segment3 common_segment(const TrianglePoints& a, const TrianglePoints& b, const std::array<ShiftPlanes, 2>& faces,
                        const Vec3& witness) noexcept;

// All shifts of b after which it still meets a, for two triangles that meet. Up to rounding, this is a convex set
// between pairs of planes, whose normals are those of the triangles and the cross products of their edges. The set is
// flat for triangles in one plane.
class MeetingShifts {
 public:
  MeetingShifts() = default;
  MeetingShifts(const TrianglePoints& a, const TrianglePoints& b) noexcept;

  // How far b can move along a direction and still meet a, and the normal of the plane at which they part, pointing
  // along the direction.
  struct Exit {
    double way;
    Vec3 normal;
  };
  // If the exact way is at most `least`, the result may be any way up to `least`.
  Exit exit(const Vec3& direction, double least) const noexcept;
  // Returns whether b meets a all the way to t * direction. False if the set is flat.
  bool contain(const Vec3& direction, double t) const noexcept;
  // Returns approximately the shortest shift that leads out of the set; 0 if the set is flat.
  Vec3 shortest_way_out() const noexcept;
  double shortest() const noexcept;  // the length of shortest_way_out()

 private:
  static constexpr std::size_t kPlanes = 11;
  std::array<ShiftPlanes, kPlanes> planes_;  // the first count_ are in use
  std::size_t count_ = 0;
  double slack_ = 0;
  bool flat_ = false;
};

}  // namespace orchard::runtime::detail
