#include "collision/kernels/front_block.h"

#include <bit>
#include <cmath>
#include <limits>

#include "collision/kernels/box_pair.h"
#include "collision/kernels/eight.h"
#include "simd/machine.h"

// Rounding. Boxes: as for their gaps. Leaves: u . p of points placed to within sigma, with |p| <= D and
// |u|_1 <= 1.74, is off by less than 1.74 sigma + 7 u D, and the difference of two such by less than twice the margin
// (placed_trees.cpp, (5)). Gaps that close: Shift::error.
namespace orchard::runtime::detail {
namespace {

constexpr int kReflections = 4;
constexpr float kUnitError = 0x1p-18f;  // vectors are of length 1 to within 1e-6: so much of a gap may not be there

template <typename Kind>
ORCHARD_INLINE void find_axes_of(const Boxes<Kind>& p, const Boxes<Kind>& q, const Placement* turned, float margin,
                                 BoxAxes& result) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  const BoxPair<Kind> pair(p, q);
  const Floats far = pair.distance + E::all(kMinDistance);
  BestAxis<Kind> best = {pair.ball_gap, {pair.d.x / far, pair.d.y / far, pair.d.z / far}};
  pair.find(best);
  if (turned != nullptr) best.u = E::turn(turned->turn, best.u);
  store(best.u.x, result.ux), store(best.u.y, result.uy), store(best.u.z, result.uz);
  const Floats gap = best.gap - E::all(margin);
  store(gap, result.gap);
  result.used = Kind::bits(E::all(0.0f) <= q.radius);
  result.meeting = result.used & ~Kind::bits(E::all(0.0f) < gap);
}

template <typename Kind>
ORCHARD_INLINE void find_axes(const NodeBox& single, const ObbNodeBlock& lanes, const Placement* placement,
                              float margin, BoxAxes& result) noexcept {
  const float scale = placement != nullptr ? placement->scale : 1;
  find_axes_of<Kind>(Boxes<Kind>::of(single), Boxes<Kind>::of(lanes, scale, 0), placement, margin, result);
}

template <typename Kind>
ORCHARD_INLINE void find_pair_axes(const ObbNodeBlock& firsts, const ObbNodeBlock& seconds, const Placement& placement,
                                   float margin, BoxAxes& result) noexcept {
  find_axes_of<Kind>(Boxes<Kind>::of(firsts, 1, 0), Boxes<Kind>::of(seconds, 1, 0).moved(placement), nullptr, margin,
                     result);
}

// The corner that is least far along u.
template <typename Kind>
ORCHARD_INLINE std::array<float, 3> extreme(const typename Eight<Kind>::Vectors (&corner)[3],
                                            const std::array<float, 3>& u) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const Vectors axis = {E::all(u[0]), E::all(u[1]), E::all(u[2])};
  Floats least = E::dot(axis, corner[0]);
  Vectors at = corner[0];
  for (std::size_t k = 1; k < 3; ++k) {
    const Floats along = E::dot(axis, corner[k]);
    const auto less = along < least;
    least = Kind::choose(less, along, least);
    at = {Kind::choose(less, corner[k].x, at.x), Kind::choose(less, corner[k].y, at.y),
          Kind::choose(less, corner[k].z, at.z)};
  }
  const auto lane = static_cast<std::uint32_t>(std::countr_zero(Kind::bits(least <= E::all(least_of<Kind>(least)))));
  std::array<float, kBlockWidth> x, y, z;
  store(at.x, x), store(at.y, y), store(at.z, z);
  return {x[lane % kBlockWidth], y[lane % kBlockWidth], z[lane % kBlockWidth]};
}

template <typename Kind>
ORCHARD_INLINE LeafAxis find_leaf_axis(const LeafPair& pair, const Placement& placement,
                                       const std::array<float, 3>* given, float enough) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const Vectors lane[3] = {E::corner(pair.lanes, 0), E::corner(pair.lanes, 1), E::corner(pair.lanes, 2)};
  const Vectors row[3] = {E::move(placement, E::corner(pair.rows, 0)), E::move(placement, E::corner(pair.rows, 1)),
                          E::move(placement, E::corner(pair.rows, 2))};
  const NodeBox &p = pair.lane_box, &q = pair.row_box;
  const float dx = q.center[0] - p.center[0], dy = q.center[1] - p.center[1], dz = q.center[2] - p.center[2];
  const auto facing = [&](float x, float y, float z) -> std::array<float, 3> {
    return x * dx + y * dy + z * dz < 0 ? std::array<float, 3>{-x, -y, -z} : std::array<float, 3>{x, y, z};
  };
  const float length = std::sqrt(dx * dx + dy * dy + dz * dz) + kMinDistance;
  const std::array<float, 3> axes[] = {
      {dx / length, dy / length, dz / length}, facing(p.n[0], p.n[1], p.n[2]), facing(q.n[0], q.n[1], q.n[2])};
  LeafAxis best = {-1, axes[0]};
  const auto try_axis = [&](const std::array<float, 3>& u, bool first) ORCHARD_INLINE_LAMBDA {
    const Vectors axis = {E::all(u[0]), E::all(u[1]), E::all(u[2])};
    const auto along = [&](const Vectors& v) ORCHARD_INLINE_LAMBDA -> Floats { return E::dot(axis, v); };
    const Floats near = E::max(E::max(along(lane[0]), along(lane[1])), along(lane[2]));
    const Floats far = E::min(E::min(along(row[0]), along(row[1])), along(row[2]));
    const float apart = least_of<Kind>(far) + least_of<Kind>(-near) - 2 * placement.margin;
    const float gap = apart - (apart < 0 ? -apart : apart) * kUnitError;
    const bool better = first || best.gap < gap;
    if (better) best = {gap, u};
    return better;
  };
  bool first = true;
  if (given != nullptr) {
    try_axis(*given, true);
    first = false;
    if (best.gap >= enough) return best;
  }
  for (const std::array<float, 3>& u : axes) {
    try_axis(u, first);
    first = false;
    if (best.gap >= enough) return best;
  }
  // As long as it gets better, reflected in the line through the points that are in the way (Chung and Wang 1996).
  for (int turn = 0; turn < kReflections && best.gap <= 0; ++turn) {
    const std::array<float, 3> u = best.u, last = extreme<Kind>(lane, {-u[0], -u[1], -u[2]}),
                               next = extreme<Kind>(row, u);
    const float x = next[0] - last[0], y = next[1] - last[1], z = next[2] - last[2];
    const float square = x * x + y * y + z * z, over = u[0] * x + u[1] * y + u[2] * z;
    if (!(square > 0)) break;
    const float factor = 2 * over / square;
    std::array<float, 3> v = {u[0] - factor * x, u[1] - factor * y, u[2] - factor * z};
    const float size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + kMinDistance;
    v = {v[0] / size, v[1] / size, v[2] / size};
    if (!try_axis(v, false)) break;
  }
  return best;
}

template <typename Kind>
ORCHARD_INLINE float take_from_gaps(const Shift& shift, FrontBlock* blocks, std::uint32_t count,
                                    std::uint64_t* open) noexcept {
  using E = Eight<Kind>;
  using Floats = typename E::Floats;
  using Vectors = typename E::Vectors;
  const Floats swing = E::all(shift.swing), error = E::all(shift.error), zero = E::all(0.0f);
  const Floats infinite = E::all(std::numeric_limits<float>::infinity());
  Floats least = infinite;
  for (std::uint32_t from = 0; from < count; from += kBlockWidth) {
    std::uint64_t bits = 0;
    const std::uint32_t end = from + kBlockWidth < count ? from + kBlockWidth : count;
    for (std::uint32_t i = from; i < end; ++i) {
      FrontBlock& block = blocks[i];
      const Vectors c = {load<Floats>(block.x), load<Floats>(block.y), load<Floats>(block.z)};
      const Vectors u = {load<Floats>(block.ux), load<Floats>(block.uy), load<Floats>(block.uz)};
      const Vectors turned = E::turn(shift.turn, c);
      const Vectors way = {turned.x + E::all(shift.by[0]), turned.y + E::all(shift.by[1]),
                           turned.z + E::all(shift.by[2])};
      const Floats gap = load<Floats>(block.gap) + E::dot(u, way) - (load<Floats>(block.radius) * swing + error);
      store(gap, block.gap);
      const auto apart = zero < gap;
      least = E::min(least, Kind::choose(apart, gap, infinite));
      bits |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(~Kind::bits(apart))) << (kBlockWidth * (i - from));
    }
    open[from / kBlockWidth] = bits;
  }
  return least_of<Kind>(least);
}

}  // namespace

void box_axes(const NodeBox& single, const ObbNodeBlock& lanes, const Placement* placement, float margin,
              BoxAxes& result) noexcept {
  PerMachine<find_axes<Widest>, find_axes<Base>>::call(single, lanes, placement, margin, result);
}
void box_axes_scalar(const NodeBox& single, const ObbNodeBlock& lanes, const Placement* placement, float margin,
                     BoxAxes& result) noexcept {
  find_axes<PlainFloats>(single, lanes, placement, margin, result);
}

void box_pair_axes(const ObbNodeBlock& firsts, const ObbNodeBlock& seconds, const Placement& placement, float margin,
                   BoxAxes& result) noexcept {
  PerMachine<find_pair_axes<Widest>, find_pair_axes<Base>>::call(firsts, seconds, placement, margin, result);
}
void box_pair_axes_scalar(const ObbNodeBlock& firsts, const ObbNodeBlock& seconds, const Placement& placement,
                          float margin, BoxAxes& result) noexcept {
  find_pair_axes<PlainFloats>(firsts, seconds, placement, margin, result);
}

LeafAxis leaf_axis(const LeafPair& pair, const Placement& placement, const std::array<float, 3>* given,
                   float enough) noexcept {
  return PerMachine<find_leaf_axis<Widest>, find_leaf_axis<Base>>::call(pair, placement, given, enough);
}
LeafAxis leaf_axis_scalar(const LeafPair& pair, const Placement& placement, const std::array<float, 3>* given,
                          float enough) noexcept {
  return find_leaf_axis<PlainFloats>(pair, placement, given, enough);
}

float close_gaps(const Shift& shift, FrontBlock* blocks, std::uint32_t count, std::uint64_t* open) noexcept {
  return PerMachine<take_from_gaps<Widest>, take_from_gaps<Base>>::call(shift, blocks, count, open);
}
float close_gaps_scalar(const Shift& shift, FrontBlock* blocks, std::uint32_t count, std::uint64_t* open) noexcept {
  return take_from_gaps<PlainFloats>(shift, blocks, count, open);
}

}  // namespace orchard::runtime::detail
