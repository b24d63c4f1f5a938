#include "collision/kernels/sphere_block.h"

#include <bit>
#include <cstring>
#include <limits>

#include "simd/machine.h"
#include "simd/vector_support.h"

namespace orchard::runtime::detail {
namespace {

constexpr float kFar = 4e18f;  // x of unused lanes: keeps them out of min_excess unless bodies are as large

struct PlainKind {
  using Floats = Several<float, kBlockWidth>;
  using Words = Several<std::uint32_t, kBlockWidth>;
  static Words words(const Words& mask) noexcept { return mask; }
  static std::uint64_t low_bytes(const Words& w) noexcept {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < kBlockWidth; ++i) bytes |= std::uint64_t{w[i] & 0xffu} << (8 * i);
    return bytes;
  }
  template <typename T>
  static T choose(const Words& mask, const T& a, const T& b) noexcept {
    return T::make([&](std::size_t i) { return mask[i] ? a[i] : b[i]; });
  }
};

#ifdef ORCHARD_VECTORS
struct VectorKind {
  using Floats __attribute__((vector_size(32))) = float;
  using Words __attribute__((vector_size(32))) = std::uint32_t;
  using Signs __attribute__((vector_size(32))) = std::int32_t;  // what comparisons give
  using Bytes __attribute__((vector_size(8))) = std::uint8_t;
  ORCHARD_INLINE static Words words(const Signs& mask) noexcept { return reinterpret_cast<Words>(mask); }
  ORCHARD_INLINE static std::uint64_t low_bytes(const Words& w) noexcept {
    const Bytes narrow = __builtin_convertvector(w, Bytes);
    std::uint64_t bytes;
    std::memcpy(&bytes, &narrow, sizeof bytes);
    return bytes;
  }
  template <typename T>
  ORCHARD_INLINE static T choose(const Signs& mask, const T& a, const T& b) noexcept {
    return mask ? a : b;
  }
};
#endif

// Byte i, bit j to byte j, bit i.
ORCHARD_INLINE std::uint64_t transposed(std::uint64_t m) noexcept {
  std::uint64_t t = (m ^ (m >> 7)) & 0x00aa00aa00aa00aau;
  m ^= t ^ (t << 7);
  t = (m ^ (m >> 14)) & 0x0000cccc0000ccccu;
  m ^= t ^ (t << 14);
  t = (m ^ (m >> 28)) & 0x00000000f0f0f0f0u;
  return m ^ t ^ (t << 28);
}

// Eight bytes that are 0 or 1 to eight bits, and back.
ORCHARD_INLINE std::uint64_t bits_of(std::uint64_t flags) noexcept { return (flags * 0x0102040810204080u) >> 56; }
ORCHARD_INLINE std::uint64_t flags_of(std::uint64_t bits) noexcept {
  const std::uint64_t one_each = (bits * 0x0101010101010101u) & 0x8040201008040201u;
  return ((one_each + 0x7f7f7f7f7f7f7f7fu) >> 7) & 0x0101010101010101u;
}

template <typename Kind>
struct Centers {
  typename Kind::Floats x, y, z;
};

template <typename Kind>
ORCHARD_INLINE Centers<Kind> centers_of(const SiblingBlock& block, bool move, const Placement& placement) noexcept {
  using Floats = typename Kind::Floats;
  const Floats x = load<Floats>(block.x), y = load<Floats>(block.y), z = load<Floats>(block.z);
  if (!move) return {x, y, z};
  const auto component = [&](std::size_t i) ORCHARD_INLINE_LAMBDA -> Floats {
    return spread<Floats>(placement.rotation[3 * i]) * x + spread<Floats>(placement.rotation[3 * i + 1]) * y +
           spread<Floats>(placement.rotation[3 * i + 2]) * z + spread<Floats>(placement.translation[i]);
  };
  return {component(0), component(1), component(2)};
}

// The bits of links that end in a leaf.
template <typename Kind>
ORCHARD_INLINE std::uint64_t leaves_of(const SiblingBlock& block) noexcept {
  using Words = typename Kind::Words;
  const Words sign = spread<Words>(~kLeafBit), ones = spread<Words>(1u);
  return bits_of(Kind::low_bytes(Kind::words(sign < load<Words>(block.link)) & ones));
}

// Of the pairs that meet, those whose errors or depths may give a lower separation bound than the best one so far.
template <typename Kind>
ORCHARD_INLINE std::uint64_t find_improving(const BlockPair& pair, const Placement& placement, const LevelState& level,
                                            const BlockHits& hits) noexcept {
  using Floats = typename Kind::Floats;
  using Words = typename Kind::Words;
  const SiblingBlock &rows = *pair.rows, &lanes = *pair.lanes;
  const float row_scale = pair.lanes_are_second ? 1.0f : placement.scale;
  const Floats zero = spread<Floats>(0.0f), lane_scale = spread<Floats>(pair.lanes_are_second ? placement.scale : 1.0f);

  const bool only_leaves = (hits.meeting & ~hits.leaves) == 0;
  const float best_mixed = level.best_inner < level.best_leaf ? level.best_leaf : level.best_inner;
  const Floats best = spread<Floats>(only_leaves ? level.best_leaf : hits.leaves == 0 ? level.best_inner : best_mixed);
  const Floats errors = load<Floats>(lanes.error) * lane_scale, depths = load<Floats>(lanes.depth) * lane_scale;
  const Floats unknown = spread<Floats>(std::numeric_limits<float>::infinity());
  if (Kind::low_bytes(Kind::words(errors < best) | Kind::words(depths < unknown)) == 0) return 0;
  Words improve = spread<Words>(0u);
  for (std::uint32_t r = pair.row_begin; r < pair.row_end; ++r) {
    if ((hits.meeting >> (8 * r) & 0xff) == 0) continue;
    const Floats rest = best - (depths + spread<Floats>(rows.depth[r] * row_scale)),
                 square = load<Floats>(hits.square[r]);
    const Words better = Kind::words(errors + spread<Floats>(rows.error[r] * row_scale) < best) |
                         (Kind::words(zero < rest) & Kind::words(square < rest * rest));
    improve = improve | (better & spread<Words>(1u << r));
  }
  const std::uint64_t improve_bytes = Kind::low_bytes(improve);
  return improve_bytes == 0 ? 0 : hits.meeting & transposed(improve_bytes);
}

template <typename Kind>
ORCHARD_INLINE void test(const BlockPair& pair, const Placement& placement, LevelState& level,
                         BlockHits& hits) noexcept {
  using Floats = typename Kind::Floats;
  using Words = typename Kind::Words;
  const SiblingBlock &rows = *pair.rows, &lanes = *pair.lanes;
  const Floats far = spread<Floats>(kFar), zero = spread<Floats>(0.0f);
  const Words ones = spread<Words>(1u);

  Centers<Kind> c = centers_of<Kind>(lanes, pair.lanes_are_second, placement);
  const Words index = load<Words>(std::array<std::uint32_t, kBlockWidth>{0, 1, 2, 3, 4, 5, 6, 7});
  const auto used = index < spread<Words>(pair.lane_count);
  c.x = Kind::choose(used, c.x, far);
  const Floats scale = spread<Floats>(placement.scale), one = spread<Floats>(1.0f);
  const Floats lane_scale = pair.lanes_are_second ? scale : one, row_scale = pair.lanes_are_second ? one : scale;
  const Floats lane_radius = load<Floats>(lanes.radius) * lane_scale;

  const Centers<Kind> row_centers = centers_of<Kind>(rows, !pair.lanes_are_second, placement);
  const Floats row_radius = load<Floats>(rows.radius) * row_scale + spread<Floats>(placement.slack);
  std::array<float, kBlockWidth> row_x, row_y, row_z, row_reach;
  store(row_centers.x, row_x), store(row_centers.y, row_y), store(row_centers.z, row_z), store(row_radius, row_reach);

  const auto keep_larger = [](const Floats& a, std::array<float, kBlockWidth>& largest) ORCHARD_INLINE_LAMBDA {
    const Floats old = load<Floats>(largest);
    store(Kind::choose(old < a, a, old), largest);
  };
  keep_larger(row_radius, level.row_radius);
  keep_larger(lane_radius, level.lane_radius);

  // Rows of bits per lane. The bits of positive floats are ordered as they are, those of others lie above them.
  Words met = spread<Words>(0u), least = load<Words>(level.min_excess);
  for (std::uint32_t r = pair.row_begin; r < pair.row_end; ++r) {
    const Floats dx = c.x - spread<Floats>(row_x[r]), dy = c.y - spread<Floats>(row_y[r]),
                 dz = c.z - spread<Floats>(row_z[r]);
    const Floats square = dx * dx + dy * dy + dz * dz;
    const Floats reach = lane_radius + spread<Floats>(row_reach[r]);
    const Floats excess = square - reach * reach;  // <= 0 exactly if square <= reach * reach
    store(square, hits.square[r]);
    met = met | (Kind::words(excess <= zero) & spread<Words>(1u << r));
    const Words bits = load<Words>(excess) - ones;
    least = Kind::choose(bits < least, bits, least);
  }
  store(least, level.min_excess);
  const std::uint64_t lane_bits = (std::uint64_t{1} << pair.lane_count) - 1;
  hits.meeting = hits.leaves = hits.improving = 0;
  const std::uint64_t met_bytes = Kind::low_bytes(met);
  if (met_bytes == 0) return;
  hits.meeting = transposed(met_bytes) & (lane_bits * 0x0101010101010101u);
  if (hits.meeting == 0) return;

  hits.leaves = hits.meeting & (flags_of(leaves_of<Kind>(rows)) * leaves_of<Kind>(lanes));
  hits.improving = find_improving<Kind>(pair, placement, level, hits);
}

}  // namespace

void test_block_scalar(const BlockPair& pair, const Placement& placement, LevelState& level, BlockHits& hits) noexcept {
  test<PlainKind>(pair, placement, level, hits);
}

#ifdef ORCHARD_VECTORS
using WidestKind = VectorKind;
#else
using WidestKind = PlainKind;
#endif

void test_block(const BlockPair& pair, const Placement& placement, LevelState& level, BlockHits& hits) noexcept {
  PerMachine<test<WidestKind>>::call(pair, placement, level, hits);
}

}  // namespace orchard::runtime::detail
