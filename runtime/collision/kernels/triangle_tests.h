#pragma once
#include "collision/kernels/eight.h"
#include "collision/kernels/node_box.h"

// The tests that the inner loops over triangles (triangle_block.cpp, segment_block.cpp) consist of.
//
// Rounding. For planes of boxes, see placed_trees.cpp, (5). For triangles, any fixed vector can be an axis, so an axis
// itself need not be accurate; only the projections to it must be. Let points be placed with an error of at most sigma.
// Points that are more than the margin apart along a coordinate are apart. A projection a . (p - q) is computed with an
// error of at most |a|_1 (2 sigma + 8 u D), which is below |a|_1 margin, where |a|_1 is the sum of the absolute
// components. Such projections are of the third or fourth degree in the coordinates: coordinates of 1e13 would
// overflow, and those of 1e-13 would underflow. So triangles are first multiplied by a power of two (Placement::unit),
// which makes every coordinate at most 1 and changes no digit. What then underflows, or is dropped by a flush-to-zero
// mode, is at most 2^-126 per operation, and below 2^-120 per projection, which kMinRoom covers.
namespace orchard::runtime::detail {

inline constexpr float kMinRoom = 0x1p-110f;  // is added to the room along an axis, in units of Placement::whole

template <typename Kind>
struct Extent {
  typename Kind::Floats low, high;
};

template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE Extent<Kind> extent(const typename Kind::Floats& a, const typename Kind::Floats& b,
                                   const typename Kind::Floats& c) noexcept {
  return {E::min(E::min(a, b), c), E::max(E::max(a, b), c)};
}

template <typename Kind>
struct Box {
  typename Eight<Kind>::Vectors low, high;
};

// Returns the boxes around eight triangles, enlarged by `margin`.
template <typename Kind>
ORCHARD_INLINE Box<Kind> box_of(const typename Eight<Kind>::Vectors (&corner)[3],
                                const typename Kind::Floats& margin) noexcept {
  const Extent<Kind> x = extent<Kind>(corner[0].x, corner[1].x, corner[2].x),
                     y = extent<Kind>(corner[0].y, corner[1].y, corner[2].y),
                     z = extent<Kind>(corner[0].z, corner[1].z, corner[2].z);
  return {{x.low - margin, y.low - margin, z.low - margin}, {x.high + margin, y.high + margin, z.high + margin}};
}

// Returns a mask of the triangles that are wholly outside of the slab between two parallel planes.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE auto beyond_planes(const typename Eight<Kind>::Vectors (&from)[3], const auto& normal, float height,
                                  const typename Kind::Floats& margin) noexcept {
  const typename E::Vectors n = E::all_of(normal);
  const Extent<Kind> e = extent<Kind>(E::dot(n, from[0]), E::dot(n, from[1]), E::dot(n, from[2]));
  const auto limit = E::all(height) + margin;
  return (limit < e.low) | (e.high < -limit);
}

// Returns a mask of the triangles that a plane of a box separates from it.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE auto beyond_box(const typename Eight<Kind>::Vectors (&corner)[3], const NodeBox& b,
                               const typename Kind::Floats& margin) noexcept {
  const typename E::Vectors center = E::all_of(b.center);
  const typename E::Vectors from[3] = {E::minus(corner[0], center), E::minus(corner[1], center),
                                       E::minus(corner[2], center)};
  return beyond_planes<Kind>(from, b.n, b.height, margin) | beyond_planes<Kind>(from, b.m, b.width, margin) |
         beyond_planes<Kind>(from, third_normal(b), b.length, margin);
}

// The triangles of eight lanes, and their planes.
template <typename Kind>
struct Lanes {
  using Vectors = typename Eight<Kind>::Vectors;
  Vectors corner[3], edge[3], normal;
  typename Kind::Floats limit;  // own_height() of each
};

// Returns the lanes of `left` whose triangles are not separated from the triangle p by the plane of p, by their own
// planes, or along the cross product of two edges. `limit` is own_height() of p.
template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE std::uint32_t not_apart(std::uint32_t left, const Lanes<Kind>& lanes,
                                       const typename Eight<Kind>::Vectors (&p)[3],
                                       const typename Eight<Kind>::Vectors& normal, const typename Kind::Floats& limit,
                                       const typename Kind::Floats& margin) noexcept {
  const Vectors from[3] = {E::minus(lanes.corner[0], p[0]), E::minus(lanes.corner[1], p[0]),
                           E::minus(lanes.corner[2], p[0])};
  const Extent<Kind> over_row = extent<Kind>(E::dot(normal, from[0]), E::dot(normal, from[1]), E::dot(normal, from[2]));
  left &= ~Kind::bits((limit < over_row.low) | (over_row.high < -limit));
  if (left == 0) return 0;
  const Extent<Kind> over_lane =
      extent<Kind>(-E::dot(lanes.normal, from[0]), E::dot(lanes.normal, E::minus(p[1], lanes.corner[0])),
                   E::dot(lanes.normal, E::minus(p[2], lanes.corner[0])));
  left &= ~Kind::bits((lanes.limit < over_lane.low) | (over_lane.high < -lanes.limit));
  if (left == 0) return 0;
  const Vectors edges[3] = {E::minus(p[1], p[0]), E::minus(p[2], p[1]), E::minus(p[0], p[2])};
  const Floats zero = E::all(0.0f), least = E::all(kMinRoom);
  for (std::size_t i = 0; i < 3 && left != 0; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vectors axis = E::cross(edges[i], lanes.edge[j]);
      const auto project = [&](const Vectors& v) ORCHARD_INLINE_LAMBDA { return E::dot(axis, E::minus(v, p[0])); };
      const Extent<Kind> of_row = extent<Kind>(zero, project(p[1]), project(p[2]));
      const Extent<Kind> of_lane = extent<Kind>(E::dot(axis, from[0]), E::dot(axis, from[1]), E::dot(axis, from[2]));
      const Floats room = E::one_norm(axis) * margin + least;
      left &= ~Kind::bits((of_row.high + room < of_lane.low) | (of_lane.high + room < of_row.low));
    }
  }
  return left;
}

// Returns a bound on the heights of a triangle's own corners over its plane through the first corner. They are 0 except
// for rounding.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Kind::Floats own_height(const typename Eight<Kind>::Vectors& normal,
                                                const typename Eight<Kind>::Vectors (&edge)[2],
                                                const typename Kind::Floats& margin) noexcept {
  return E::max(E::abs(E::dot(normal, edge[0])), E::abs(E::dot(normal, edge[1]))) +
         (E::one_norm(normal) * margin + E::all(kMinRoom));
}

template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Eight<Kind>::Vectors normalised(const typename Eight<Kind>::Vectors& v) noexcept {
  const typename E::Floats size = Kind::sqrt(E::dot(v, v)) + E::all(kMinDistance);
  return {v.x / size, v.y / size, v.z / size};
}

template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Eight<Kind>::Vectors normal_of(const typename Eight<Kind>::Vectors (&t)[3]) noexcept {
  return normalised<Kind>(E::cross(E::minus(t[1], t[0]), E::minus(t[2], t[0])));
}

template <typename Kind>
ORCHARD_INLINE typename Eight<Kind>::Vectors middle_of(const typename Eight<Kind>::Vectors (&t)[3]) noexcept {
  const typename Kind::Floats third = Eight<Kind>::all(1.0f / 3);
  return {(t[0].x + t[1].x + t[2].x) * third, (t[0].y + t[1].y + t[2].y) * third, (t[0].z + t[1].z + t[2].z) * third};
}

template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE Extent<Kind> extent_along(const typename Eight<Kind>::Vectors& axis,
                                         const typename Eight<Kind>::Vectors (&t)[3]) noexcept {
  return extent<Kind>(E::dot(axis, t[0]), E::dot(axis, t[1]), E::dot(axis, t[2]));
}

// Returns the largest gap between two boxes along a coordinate axis.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Kind::Floats gap_between(const Box<Kind>& a, const typename Eight<Kind>::Vectors& low,
                                                 const typename Eight<Kind>::Vectors& high) noexcept {
  return E::max(E::max(E::max(a.low.x - high.x, low.x - a.high.x), E::max(a.low.y - high.y, low.y - a.high.y)),
                E::max(a.low.z - high.z, low.z - a.high.z));
}

// Returns the gaps between the triangles `lane` and the triangle p along an axis.
template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Kind::Floats gap_along(const typename Eight<Kind>::Vectors& axis,
                                               const typename Eight<Kind>::Vectors (&lane)[3],
                                               const typename Eight<Kind>::Vectors (&p)[3]) noexcept {
  const auto project = [&](const auto& v) ORCHARD_INLINE_LAMBDA { return E::dot(axis, E::minus(v, p[0])); };
  const Extent<Kind> l = extent<Kind>(project(lane[0]), project(lane[1]), project(lane[2]));
  const Extent<Kind> r = extent<Kind>(E::all(0.0f), project(p[1]), project(p[2]));
  return E::max(l.low - r.high, r.low - l.high);
}

}  // namespace orchard::runtime::detail
