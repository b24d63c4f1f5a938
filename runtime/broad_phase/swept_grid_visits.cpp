#include <bit>
#include <cstring>

#include "broad_phase/cell_entry.h"
#include "simd/machine.h"

// Which cells of the grid boxes take, and how they lie in them.
namespace orchard::runtime::detail {
namespace {

// The neighbours of a cell that lie further along some axes, a bit each. Of boxes that go on to one of them: which
// fields of what lies before their begin are 0 there, how much further its line is, and the steps to there.
struct Corners {
  template <typename Of>
  static constexpr std::uint32_t sum(std::uint32_t corner, const Of& of) noexcept {
    std::uint32_t all = 0;
    for (std::uint32_t d = 0; d < 3; ++d) all += (corner >> d & 1) * of(d);
    return all;
  }
  static constexpr std::uint32_t fields(std::uint32_t corner) noexcept {
    return sum(corner, [](std::uint32_t d) { return kLastInEntry << kFieldBits * d; });
  }
  static constexpr std::uint32_t steps(std::uint32_t corner) noexcept {
    return sum(corner, [](std::uint32_t d) { return 1u << 2 * d; });
  }
  ORCHARD_INLINE static std::uint32_t line(std::uint32_t corner, const std::array<std::uint32_t, 3>& factors) noexcept {
    return sum(corner, [&](std::uint32_t d) ORCHARD_INLINE_LAMBDA { return factors[d]; });
  }
};

}  // namespace

// Where bodies' boxes lie in their first cells, by body.
struct SweptGrid::Coded {
  alignas(64) Numbers ids;
  alignas(64) Numbers from, below;  // in fields, as of a box that takes one cell
  alignas(64) Numbers beyond;       // the fields of the axes along which the box takes the next cell, too
  alignas(64) Numbers lines;        // those with the same last bits are one
  alignas(64) Numbers axes;         // these axes, a bit each, and one above for more than two cells along any
};

// A loop without branches that depend on the data.
ORCHARD_INLINE void SweptGrid::code(Coded& coded, const Some& some) const noexcept {
  const std::size_t count = std::min(some.bodies.size(), kBatch);  // GCC does not know that there are no more
  const std::size_t lanes = lanes_for(count);
  const BoxBlock& block = some.block;
  for (std::size_t i = 0; i < count; ++i) coded.ids[i] = some.bodies[i];
  for (std::size_t i = count; i < lanes; ++i) coded.ids[i] = 0;
  const std::uint32_t factor_y = factors_[1], factor_z = factors_[2];  // the first one is 1
  for (std::size_t i = 0; i < lanes; ++i) {
    std::uint32_t from = 0, below = 0, beyond = 0, line = 0, axes = 0;
    for (std::uint32_t d = 0; d < 3; ++d) {
      const std::uint32_t lower = block.lower[d][some.first + i], upper = block.upper[d][some.first + i];
      const std::uint32_t cell = lower >> kQuantumBits, more = (upper >> kQuantumBits) - cell;
      const std::uint32_t two = (more | more >> 1) & 1;
      from |= (lower >> kCoarser & kLastInEntry) << kFieldBits * d;
      below |= (~upper >> kCoarser & kLastInEntry) << kFieldBits * d;
      beyond |= two * (kLastInEntry << kFieldBits * d);
      axes |= two << d | (more & 2) << 2;
      line += d == 0 ? cell : cell * (d == 1 ? factor_y : factor_z);
    }
    coded.from[i] = from, coded.below[i] = below, coded.beyond[i] = beyond;
    coded.lines[i] = line, coded.axes[i] = axes;
  }
}

ORCHARD_INLINE void SweptGrid::encode_all(Batch& batch, const Some& some) const noexcept {
  const std::uint32_t mask = mask_;
  Coded coded;
  code(coded, some);
  const std::size_t count = std::min(some.bodies.size(), kBatch), lanes = lanes_for(count);
  for (std::size_t i = 0; i < lanes; ++i) {
    const std::uint64_t from = coded.from[i], below = coded.below[i] & ~coded.beyond[i];
    batch.entries[i] = entry_of(from, below) | std::uint64_t{coded.ids[i]} << kIdShift;
    batch.queries[i] = entry_of(below, from);
  }
  for (std::size_t i = 0; i < lanes; ++i) batch.lines[i] = coded.lines[i] & mask;
  for (std::size_t i = 0; i < lanes; ++i) batch.steps[i] = 0;
  batch.larges = 0;
  batch.count = batch.end = count;
  const AxisBits bits = bits_of(coded.axes, count);
  for (std::uint64_t rest = bits.many; rest != 0; rest &= rest - 1) {
    batch.large[batch.larges++] = coded.ids[static_cast<std::size_t>(std::countr_zero(rest))];
  }
  add_corners(batch, coded, bits);
}

// As bits. The numbers are small.
ORCHARD_INLINE SweptGrid::AxisBits SweptGrid::bits_of(const Numbers& axes, std::size_t count) noexcept {
  AxisBits bits{};
#if defined(ORCHARD_VECTORS) && defined(__SSE2__)
  using Four __attribute__((vector_size(16))) = std::int32_t;
  const auto four = [&](std::size_t i) ORCHARD_INLINE_LAMBDA {
    Four result;
    std::memcpy(&result, &axes[i], sizeof result);
    return reinterpret_cast<__m128i>(result);
  };
  for (std::size_t i = 0; i < lanes_for(count); i += 8) {
    const __m128i eight = _mm_packs_epi32(four(i), four(i + 4)), bytes = _mm_packs_epi16(eight, eight);
    const auto which = [&](int bit) ORCHARD_INLINE_LAMBDA {
      return static_cast<std::uint64_t>(_mm_movemask_epi8(_mm_slli_epi16(bytes, 7 - bit)) & 0xff) << i;
    };
    bits.x |= which(0), bits.y |= which(1), bits.z |= which(2), bits.many |= which(3);
  }
#else
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t taken = axes[i];
    bits.x |= (taken & 1) << i, bits.y |= (taken >> 1 & 1) << i, bits.z |= (taken >> 2 & 1) << i;
    bits.many |= (taken >> 3) << i;
  }
#endif
  const std::uint64_t there = count < kBatch ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
  bits.many &= there;
  bits.x &= there & ~bits.many, bits.y &= there & ~bits.many, bits.z &= there & ~bits.many;
  return bits;
}

// The other cells of bodies that take two along some axes, by these: mostly it is one axis.
ORCHARD_INLINE void SweptGrid::add_corners(Batch& batch, const Coded& coded, const AxisBits& bits) const noexcept {
  const std::uint64_t xy = bits.x & bits.y, xz = bits.x & bits.z, yz = bits.y & bits.z;
  std::size_t end = batch.end;
  const std::uint32_t mask = mask_;
  const auto add = [&](std::uint32_t corner, std::uint64_t taken) ORCHARD_INLINE_LAMBDA {
    const std::uint32_t line = Corners::line(corner, factors_), fields = Corners::fields(corner);
    for (; taken != 0; taken &= taken - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(taken));
      const std::uint64_t from = coded.from[i] & ~fields, below = coded.below[i] & (~coded.beyond[i] | fields);
      batch.entries[end] = entry_of(from, below) | std::uint64_t{coded.ids[i]} << kIdShift;
      batch.queries[end] = entry_of(below, from);
      batch.lines[end] = (coded.lines[i] + line) & mask;
      batch.steps[end] = static_cast<Steps>(Corners::steps(corner));
      ++end;
    }
  };
  add(1, bits.x), add(2, bits.y), add(4, bits.z);
  if ((xy | xz | yz) != 0) add(3, xy), add(5, xz), add(6, yz), add(7, xy & xz);
  batch.end = end;
}

void SweptGrid::encode(Batch& batch, std::span<const BodyIndex> bodies, const BoxBlock& block,
                       std::size_t first) const noexcept {
  const Some some{bodies, block, first};
  per_machine([&]() ORCHARD_INLINE_LAMBDA { encode_all(batch, some); });
  for (std::size_t i = 0; i < batch.end; ++i) prefetch(&lines_[batch.lines[i]]);
}

SweptGrid::Visit* SweptGrid::many_visits_of(BodyIndex body, const QuantizedAabb& box, Visit* visits) const noexcept {
  Cell first, count;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = box.lower[d] >> kQuantumBits;
    count[d] = (box.upper[d] >> kQuantumBits) - first[d] + 1;
  }
  Cell steps;
  for (steps[2] = 0; steps[2] < count[2]; ++steps[2]) {
    for (steps[1] = 0; steps[1] < count[1]; ++steps[1]) {
      for (steps[0] = steps[1] == 0 && steps[2] == 0; steps[0] < count[0]; ++steps[0]) {
        const Cell cell = {first[0] + steps[0], first[1] + steps[1], first[2] + steps[2]};
        std::uint32_t from = 0, below = 0;
        for (std::uint32_t i = 0; i < 3; ++i) {
          const std::uint32_t begin = cell[i] << kQuantumBits, end = begin + (kQuanta - 1);
          from |= (box.lower[i] > begin ? (box.lower[i] - begin) >> kCoarser : 0) << kFieldBits * i;
          below |= (box.upper[i] < end ? (end - box.upper[i]) >> kCoarser : 0) << kFieldBits * i;
        }
        *visits++ = {entry_of(from, below) | std::uint64_t{body} << kIdShift, line_of(cell),
                     static_cast<Steps>(steps[0] | steps[1] << 2 | steps[2] << 4)};
      }
    }
  }
  return visits;
}

}  // namespace orchard::runtime::detail
