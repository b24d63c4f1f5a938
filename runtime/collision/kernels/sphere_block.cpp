#include "collision/kernels/sphere_block.h"

#include <limits>

#include "collision/kernels/eight.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

constexpr float kFar = 4e18f;  // x of unused lanes: keeps them out of min_excess unless bodies are as large
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr std::uint64_t in_row(std::uint32_t row, std::uint32_t lanes) noexcept {
  return std::uint64_t{lanes} << (kBlockWidth * row);
}

// Returns the lanes that are leaves, as bits.
ORCHARD_INLINE std::uint32_t leaves_of(const SiblingBlock& block) noexcept {
  std::uint32_t leaves = 0;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) leaves |= std::uint32_t{(block.link[i] & kLeafBit) != 0} << i;
  return leaves;
}

template <typename Kind, typename E = Eight<Kind>>
ORCHARD_INLINE typename Eight<Kind>::Vectors centers_of(const SiblingBlock& block, bool move,
                                                        const Placement& placement) noexcept {
  const typename E::Vectors centers = {E::at(block.x), E::at(block.y), E::at(block.z)};
  return move ? E::move(placement, centers) : centers;
}

// Returns those of the pairs that meet whose errors or depths may give a lower separation bound than the best one so
// far.
template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats>
ORCHARD_INLINE std::uint64_t find_improving(const BlockPair& pair, const Placement& placement, const LevelState& level,
                                            const BlockHits& hits) noexcept {
  const SiblingBlock &rows = *pair.rows, &lanes = *pair.lanes;
  const float row_scale = pair.lanes_are_second ? 1.0f : placement.scale;
  const Floats zero = E::all(0.0f), lane_scale = E::all(pair.lanes_are_second ? placement.scale : 1.0f);

  const bool only_leaves = (hits.meeting & ~hits.leaves) == 0;
  const float best_mixed = level.best_inner < level.best_leaf ? level.best_leaf : level.best_inner;
  const Floats best = E::all(only_leaves ? level.best_leaf : hits.leaves == 0 ? level.best_inner : best_mixed);
  const Floats errors = E::at(lanes.error) * lane_scale, depths = E::at(lanes.depth) * lane_scale;
  if (Kind::bits((errors < best) | (depths < E::all(kInfinity))) == 0) return 0;
  std::uint64_t improving = 0;
  for (std::uint32_t r = pair.row_begin; r < pair.row_end; ++r) {
    if ((hits.meeting & in_row(r, E::kAll)) == 0) continue;
    const Floats rest = best - (depths + E::all(rows.depth[r] * row_scale)), square = E::at(hits.square[r]);
    improving |= in_row(
        r, Kind::bits((errors + E::all(rows.error[r] * row_scale) < best) | ((zero < rest) & (square < rest * rest))));
  }
  return hits.meeting & improving;
}

template <typename Kind, typename E = Eight<Kind>, typename Floats = typename E::Floats,
          typename Vectors = typename E::Vectors>
ORCHARD_INLINE void test(const BlockPair& pair, const Placement& placement, LevelState& level,
                         BlockHits& hits) noexcept {
  const SiblingBlock &rows = *pair.rows, &lanes = *pair.lanes;
  const float lane_scale = pair.lanes_are_second ? placement.scale : 1,
              row_scale = pair.lanes_are_second ? 1 : placement.scale;

  Vectors c = centers_of<Kind>(lanes, pair.lanes_are_second, placement);
  const Floats index = E::at({0, 1, 2, 3, 4, 5, 6, 7});
  c.x = Kind::choose(index < E::all(static_cast<float>(pair.lane_count)), c.x, E::all(kFar));
  const Floats lane_radius = E::at(lanes.radius) * E::all(lane_scale);
  const OneByOne<Kind> row_centers(centers_of<Kind>(rows, !pair.lanes_are_second, placement));
  const Floats row_radius = E::at(rows.radius) * E::all(row_scale) + E::all(placement.slack);
  std::array<float, kBlockWidth> row_reach;
  store(row_radius, row_reach);
  store(E::max(row_radius, E::at(level.row_radius)), level.row_radius);
  store(E::max(lane_radius, E::at(level.lane_radius)), level.lane_radius);

  Floats least = E::at(level.min_excess);
  hits.meeting = hits.leaves = hits.improving = 0;
  for (std::uint32_t r = pair.row_begin; r < pair.row_end; ++r) {
    const Vectors d = E::minus(c, row_centers[r]);
    const Floats square = E::dot(d, d), reach = lane_radius + E::all(row_reach[r]);
    const Floats excess = square - reach * reach;  // <= 0 exactly if square <= reach * reach
    store(square, hits.square[r]);
    const auto met = excess <= E::all(0.0f);
    hits.meeting |= in_row(r, Kind::bits(met));
    least = E::min(Kind::choose(met, least, excess), least);
  }
  store(least, level.min_excess);
  const std::uint32_t used = (1u << pair.lane_count) - 1;
  hits.meeting &= used * 0x0101010101010101u;
  if (hits.meeting == 0) return;
  const std::uint32_t row_leaves = leaves_of(rows), lane_leaves = leaves_of(lanes);
  for (std::uint32_t r = pair.row_begin; r < pair.row_end; ++r) {
    if ((row_leaves >> r & 1) != 0) hits.leaves |= hits.meeting & in_row(r, lane_leaves);
  }
  hits.improving = find_improving<Kind>(pair, placement, level, hits);
}

}  // namespace

void test_block(const BlockPair& pair, const Placement& placement, LevelState& level, BlockHits& hits) noexcept {
  PerMachine<test<Widest>, test<Base>, test<PlainFloats>>::call(pair, placement, level, hits);
}

}  // namespace orchard::runtime::detail
