#include "triangle_block.h"

#include <cmath>

#include "vector_support.h"

namespace orchard::runtime::detail {
namespace {

using Lanes = TriangleBlock::Lanes;

struct PlainKind {
  using Doubles = Plain<double, kTriangleWidth>;
  using Signs = Doubles::Mask;
  static Doubles choose(const Signs& mask, const Doubles& a, const Doubles& b) noexcept {
    return Doubles::make([&](std::size_t i) { return mask[i] ? a[i] : b[i]; });
  }
};

#ifdef ORCHARD_VECTORS
struct VectorKind {
  using Doubles __attribute__((vector_size(32))) = double;
  using Signs __attribute__((vector_size(32))) = std::int64_t;
  ORCHARD_INLINE static Doubles choose(const Signs& mask, const Doubles& a, const Doubles& b) noexcept {
    return mask ? a : b;
  }
};
#else
using VectorKind = PlainKind;
#endif

// The arithmetic of four triangles at a time.
template <typename Kind>
struct Four {
  using Doubles = typename Kind::Doubles;
  using Signs = typename Kind::Signs;
  struct Vectors {
    Doubles x, y, z;
  };

  ORCHARD_INLINE static Vectors spread(const Vec3& v) noexcept {
    return {detail::spread<Doubles>(v[0]), detail::spread<Doubles>(v[1]), detail::spread<Doubles>(v[2])};
  }
  ORCHARD_INLINE static Vectors load(const std::array<Lanes, 3>& from) noexcept {
    return {detail::load<Doubles>(from[0]), detail::load<Doubles>(from[1]), detail::load<Doubles>(from[2])};
  }
  ORCHARD_INLINE static Vectors minus(const Vectors& a, const Vectors& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  ORCHARD_INLINE static Doubles dot(const Vectors& a, const Vectors& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  ORCHARD_INLINE static Vectors cross(const Vectors& a, const Vectors& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  ORCHARD_INLINE static Doubles smaller(const Doubles& a, const Doubles& b) noexcept {
    return Kind::choose(a < b, a, b);
  }
  ORCHARD_INLINE static Doubles larger(const Doubles& a, const Doubles& b) noexcept {
    return Kind::choose(a < b, b, a);
  }
  ORCHARD_INLINE static std::uint32_t bits(const Signs& mask) noexcept {
    return static_cast<std::uint32_t>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
  }

  // Heights of three corners over planes.
  struct Heights {
    Doubles low, high;
  };
  ORCHARD_INLINE static Heights heights(const Vectors& axis, const Vectors& from, const Vectors (&corner)[3]) noexcept {
    const Doubles a = dot(axis, minus(corner[0], from)), b = dot(axis, minus(corner[1], from)),
                  c = dot(axis, minus(corner[2], from));
    return {smaller(smaller(a, b), c), larger(larger(a, b), c)};
  }
  ORCHARD_INLINE static std::uint32_t apart(const Heights& h, const Doubles& margin) noexcept {
    return bits((margin < h.low) | (h.high < -margin));
  }

  // Lanes whose plane passes the ball at a distance.
  ORCHARD_INLINE static std::uint32_t passing(const TriangleBlock& block, const Ball& ball,
                                              const Doubles& margin) noexcept {
    const Vectors normal = load(block.normal);
    const Doubles height = dot(normal, minus(spread(ball.center), load(block.corner[0])));
    const Doubles beyond = larger(height, -height) - margin, zero = detail::spread<Doubles>(0.0);
    const Doubles limit = detail::spread<Doubles>(ball.radius * ball.radius) * dot(normal, normal);
    return bits((zero < beyond) & (limit < beyond * beyond));
  }
};

template <typename Kind>
ORCHARD_INLINE std::uint32_t find_candidates(const TriangleBlockPair& pair) noexcept {
  using F = Four<Kind>;
  using Doubles = typename F::Doubles;
  using Vectors = typename F::Vectors;
  const TriangleBlock &rows = pair.rows, &lanes = pair.lanes;
  // A height over a plane is a determinant of six products of three differences below 2 size, so it is computed to
  // within 8 * 2^-53 * 6 * (2 size)^3; for a ball the rounding of the normal, times the radius, comes in once more.
  const Doubles margin = spread<Doubles>(0x1p-42 * pair.size * pair.size * pair.size);

  // Triangles that do not reach the other leaf's ball, by their planes and along the line through the centres.
  const Vec3 &from = pair.lane_ball.center, &to = pair.row_ball.center;
  const Vec3 way = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  const double square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2], distance = std::sqrt(square);
  const double way_margin = 0x1p-46 * pair.size * pair.size;
  const Vectors lane_corner[3] = {F::load(lanes.corner[0]), F::load(lanes.corner[1]), F::load(lanes.corner[2])};
  const Vectors row_corner[3] = {F::load(rows.corner[0]), F::load(rows.corner[1]), F::load(rows.corner[2])};
  const Doubles lane_top = F::heights(F::spread(way), F::spread(from), lane_corner).high + spread<Doubles>(way_margin);
  const Doubles row_bottom = F::heights(F::spread(way), F::spread(from), row_corner).low - spread<Doubles>(way_margin);
  const std::uint32_t low_lanes = F::bits(lane_top < spread<Doubles>(square - distance * pair.row_ball.radius));
  const std::uint32_t high_rows = F::bits(spread<Doubles>(distance * pair.lane_ball.radius) < row_bottom);
  const std::uint32_t near_lanes = ~(low_lanes | F::passing(lanes, pair.row_ball, margin)) & ((1u << lanes.count) - 1);
  const std::uint32_t near_rows = ~(high_rows | F::passing(rows, pair.lane_ball, margin)) & ((1u << rows.count) - 1);
  if (near_lanes == 0 || near_rows == 0) return 0;

  const Vectors lane_normal = F::load(lanes.normal);
  std::uint32_t result = 0;
  for (std::uint32_t row = pair.row_begin; row < pair.row_end; ++row) {
    if ((near_rows >> row & 1) == 0) continue;
    const TrianglePoints points = rows.points(row);
    const Vectors corner[3] = {F::spread(points[0]), F::spread(points[1]), F::spread(points[2])};
    const Vectors normal = F::spread({rows.normal[0][row], rows.normal[1][row], rows.normal[2][row]});
    std::uint32_t left = near_lanes & ~F::bits(lane_top < spread<Doubles>(row_bottom[row]));
    left &= ~F::apart(F::heights(normal, corner[0], lane_corner), margin);
    if (left == 0) continue;
    left &= ~F::apart(F::heights(lane_normal, lane_corner[0], corner), margin);
    result |= left << (kTriangleWidth * row);
  }
  return result;
}

}  // namespace

TrianglePoints TriangleBlock::points(std::uint32_t lane) const noexcept {
  TrianglePoints result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) result[k][i] = corner[k][i][lane];
  }
  return result;
}

ORCHARD_PER_MACHINE void load_block(const PackedSphereTree& tree, const std::uint32_t* triangles, std::uint32_t count,
                                    const Pose* pose, TriangleBlock& block) noexcept {
  using F = Four<VectorKind>;
  block.count = count;
  for (std::uint32_t lane = 0; lane < kTriangleWidth; ++lane) {
    const auto& triangle = tree.triangles[triangles[lane < count ? lane : 0]];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& vertex = tree.vertices[triangle[k]];
      for (std::size_t i = 0; i < 3; ++i) block.corner[k][i][lane] = vertex[i];
    }
  }
  F::Vectors corner[3];
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = F::load(block.corner[k]);
    if (pose == nullptr) continue;
    const F::Vectors v = corner[k];
    const auto component = [&](std::size_t i) ORCHARD_INLINE_LAMBDA -> F::Doubles {
      const auto& r = pose->rotation;
      return F::dot(F::spread({r[3 * i], r[3 * i + 1], r[3 * i + 2]}), v) + spread<F::Doubles>(pose->translation[i]);
    };
    corner[k] = {component(0), component(1), component(2)};
    store(corner[k].x, block.corner[k][0]);
    store(corner[k].y, block.corner[k][1]);
    store(corner[k].z, block.corner[k][2]);
  }
  const F::Vectors normal = F::cross(F::minus(corner[1], corner[0]), F::minus(corner[2], corner[0]));
  store(normal.x, block.normal[0]), store(normal.y, block.normal[1]), store(normal.z, block.normal[2]);
}

ORCHARD_PER_MACHINE std::uint32_t candidates(const TriangleBlockPair& pair) noexcept {
  return find_candidates<VectorKind>(pair);
}

std::uint32_t candidates_scalar(const TriangleBlockPair& pair) noexcept { return find_candidates<PlainKind>(pair); }

}  // namespace orchard::runtime::detail
