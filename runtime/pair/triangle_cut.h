#pragma once
#include "triangle_pair.h"

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

}  // namespace orchard::runtime::detail
