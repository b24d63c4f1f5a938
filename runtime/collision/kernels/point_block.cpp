#include "collision/kernels/point_block.h"

#include "collision/kernels/eight.h"
#include "simd/machine.h"

// The distance of a triangle is that of its nearest edge, or that of its plane where the point lies over the triangle.
// An edge's distance is off by a few roundings of the coordinates, which the margin covers, as any point of the edge
// would be an upper bound, and the true foot is missed by a part of the edge's length that rounding allows: to second
// order only. Over the triangle is decided with room for rounding: where it wrongly says so, the plane's distance is no
// more than the true one, either. A normal is off by less than 16 u of the product of its edges, which is taken from
// the plane's distance; that of a needle is then 0.
namespace orchard::runtime::detail {
namespace {

constexpr float kNormalError = 0x1p-20f;
constexpr float kRoom = 0x1p-18f;
constexpr float kMinLength = 1e-37f;

template <typename Kind>
ORCHARD_INLINE void find_point_gaps(const std::array<float, 3>& point, const TriangleBlock& block,
                                    const Placement& placement, PointGaps& lower) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const Vectors p = E::all_of(point);
  const Floats unit = E::all(placement.unit);
  const auto corner = [&](std::size_t k)
                          ORCHARD_INLINE_LAMBDA -> Vectors { return E::times(E::minus(E::corner(block, k), p), unit); };
  const Vectors a = corner(0), b = corner(1), c = corner(2);
  const Vectors ab = E::minus(b, a), bc = E::minus(c, b), ca = E::minus(a, c);
  const Floats zero = E::all(0.0f), one = E::all(1.0f), least = E::all(kMinLength);
  const auto edge = [&](const Vectors& from, const Vectors& way) ORCHARD_INLINE_LAMBDA -> Floats {
    const Floats t = E::min(E::max(-E::dot(from, way) / (E::dot(way, way) + least), zero), one);
    const Vectors foot = {from.x + t * way.x, from.y + t * way.y, from.z + t * way.z};
    return E::dot(foot, foot);
  };
  const Floats by_edges = Kind::sqrt(E::min(E::min(edge(a, ab), edge(b, bc)), edge(c, ca)));
  const Vectors normal = E::cross(ab, ca);  // which way does not matter
  const Floats size = Kind::sqrt(E::dot(normal, normal));
  const Floats room_n = Kind::sqrt(E::dot(ab, ab) * E::dot(ca, ca));
  const Floats reach = E::max(E::max(E::one_norm(a), E::one_norm(b)), E::one_norm(c));
  const Floats by_plane = (E::abs(E::dot(normal, a)) - room_n * reach * E::all(kNormalError)) / (size + least);
  // Signed areas of the edges with the point's foot, times the normal's length.
  const auto side = [&](const Vectors& from, const Vectors& way)
                        ORCHARD_INLINE_LAMBDA -> Floats { return E::dot(normal, E::cross(from, way)); };
  const Floats s = side(a, ab), t = side(b, bc), u = side(c, ca);
  const Floats longest = E::max(E::max(E::one_norm(ab), E::one_norm(bc)), E::one_norm(ca));
  const Floats room = room_n * reach * longest * E::all(kRoom);
  const Floats low = E::min(E::min(s, t), u), high = E::max(E::max(s, t), u);
  const auto over = (-room <= low) | (high <= room);
  const Floats best = Kind::choose(over, E::min(by_edges, E::max(by_plane, zero)), by_edges);
  store(best * E::all(placement.whole) - E::all(placement.margin), lower);
}

}  // namespace

void point_gaps(const std::array<float, 3>& point, const TriangleBlock& block, const Placement& placement,
                PointGaps& lower) noexcept {
  PerMachine<find_point_gaps<Widest>, find_point_gaps<Base>, find_point_gaps<PlainFloats>>::call(point, block,
                                                                                                 placement, lower);
}

}  // namespace orchard::runtime::detail
