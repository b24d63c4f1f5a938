#include "broad_phase/box_list.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "simd/machine.h"
#include "simd/vector_support.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kLast = 64;  // of a group
constexpr std::uint64_t kHighBits = 0x8080808080808080u, kEachByte = 0x0101010101010101u;

// From the i-th place before its middle on: high bits in the first i bytes.
alignas(64) constexpr std::array<std::uint8_t, 2 * kLast> kBefore = [] {
  std::array<std::uint8_t, 2 * kLast> bytes{};
  for (std::size_t i = 0; i < kLast; ++i) bytes[i] = 0x80;
  return bytes;
}();

}  // namespace

// Of a group's boxes, in the high bits of bytes, which meet one box whose ends are in all bytes of `lower` and `upper`.
// In parts of as many words as the machine's vectors have, or one: of wider ones GCC keeps parts in memory.
template <typename Part>
struct BoxList::PartLanes {
  static constexpr std::size_t kParts = sizeof(Words) / sizeof(Part);
  struct Bits {
    Part parts[kParts];
  };
  static constexpr Bits kNone{};
  ORCHARD_INLINE static Part at(const std::uint8_t* from) noexcept {
    Part result;
    std::memcpy(&result, from, sizeof result);
    return result;
  }
  ORCHARD_INLINE static Bits meeting(const Group& group, const std::array<std::uint64_t, 3>& lower,
                                     const std::array<std::uint64_t, 3>& upper) noexcept {
    Bits bits;
    for (std::size_t k = 0; k < kParts; ++k) bits.parts[k] = Part{} + kHighBits;
    for (std::size_t d = 0; d < 3; ++d) {
      for (std::size_t k = 0; k < kParts; ++k) {
        const std::size_t first = k * sizeof(Part);
        bits.parts[k] &= (at(&group.upper[d][first]) - lower[d]) & (upper[d] - at(&group.lower[d][first]));
      }
    }
    return bits;
  }
  ORCHARD_INLINE static Bits before(const Bits& bits, std::size_t end) noexcept {
    Bits result;
    for (std::size_t k = 0; k < kParts; ++k) {
      result.parts[k] = bits.parts[k] & at(kBefore.data() + kLast - end + k * sizeof(Part));
    }
    return result;
  }
  ORCHARD_INLINE static void include(Bits& bits, const Bits& more) noexcept {
    for (std::size_t k = 0; k < kParts; ++k) bits.parts[k] |= more.parts[k];
  }
  ORCHARD_INLINE static bool any(const Bits& bits) noexcept {
    Part sum = bits.parts[0];
    for (std::size_t k = 1; k < kParts; ++k) sum |= bits.parts[k];
    const auto words = std::bit_cast<std::array<std::uint64_t, sizeof(Part) / 8>>(sum);
    std::uint64_t all = words[0];
    for (std::size_t i = 1; i < words.size(); ++i) all |= words[i];
    return all != 0;
  }
};

#ifdef ORCHARD_VECTORS
namespace {
using TwoWords __attribute__((vector_size(16))) = std::uint64_t;
using FourWords __attribute__((vector_size(32))) = std::uint64_t;
using EightWords __attribute__((vector_size(64))) = std::uint64_t;
}  // namespace
#endif

// The first bodies lie in half of the range.
ORCHARD_INLINE void BoxList::choose_scale(const BoxBlock& block, std::size_t count) noexcept {
  constexpr std::uint32_t kHalf = (kLastCoarse + 1) / 2;
  std::array<std::uint32_t, 3> middle;
  std::uint32_t longest = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    std::uint32_t first = kLastQuantum, last = 0;
    for (std::size_t i = 0; i < count; ++i) {
      first = std::min(first, block.lower[d][i]);
      last = std::max(last, block.upper[d][i]);
    }
    longest = std::max(longest, last - first);
    middle[d] = first / 2 + last / 2;
  }
  shift_ = static_cast<unsigned>(std::bit_width(longest / kHalf));
  for (std::size_t d = 0; d < 3; ++d) first_[d] = std::max(middle[d] >> shift_, kHalf) - kHalf;
}

void BoxList::reset(std::size_t slots) {
  boxes_.clear();
  groups_.clear();
  filled_ = 0;
  grow(slots);
}

void BoxList::grow(std::size_t slots) {
  if (slots <= this->slots()) return;
  Group empty;
  for (std::size_t i = 0; i < kGroup; ++i) empty.set(i, kCoarseNowhere);
  groups_.resize((slots + kGroup - 1) / kGroup, empty);
  boxes_.resize(slots, kNowhere);
}

void BoxList::append_meeting(const QuantizedAabb& box, std::vector<BodyIndex>& bodies) const {
  for (std::size_t body = 0; body < filled_; ++body) {
    if (boxes_[body].meets(box)) bodies.push_back(static_cast<BodyIndex>(body));
  }
}

ORCHARD_INLINE void BoxList::make_coarse(const BoxBlock& block, std::size_t count, Group& group) const noexcept {
  const std::size_t lanes = count > kAtOnce / 2 ? kAtOnce : count;  // of one body vectors would be most of the work
  // Those of the group that have no body are compared with the others, and meet none.
  for (std::size_t d = 0; d < 3 && count > 1; ++d) group.lower[d].fill(kLastCoarse), group.upper[d].fill(kHighBit);
  for (std::size_t d = 0; d < 3; ++d) {
    const std::uint32_t from = first_[d], last = kLastCoarse;
    const unsigned shift = shift_;
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint32_t lower = std::max(block.lower[d][i] >> shift, from) - from,
                          upper = std::max(block.upper[d][i] >> shift, from) - from;
      group.lower[d][i] = static_cast<std::uint8_t>(std::min(lower, last));
      group.upper[d][i] = static_cast<std::uint8_t>(std::min(upper, last) | kHighBit);
    }
    for (std::size_t i = count; i < lanes; ++i) group.lower[d][i] = kLastCoarse, group.upper[d][i] = kHighBit;
  }
}

template <typename Use>
void BoxList::for_each_hit(const Words& words, const Use& use) {
  for (std::size_t w = 0; w < words.size(); ++w) {
    for (std::uint64_t hits = words[w]; hits != 0; hits &= hits - 1) {
      const auto bit = static_cast<std::size_t>(std::countr_zero(hits));
      use(8 * w + (std::endian::native == std::endian::little ? bit / 8 : 7 - bit / 8));
    }
  }
}

// Mostly a box meets none: that is found out about all of them together.
template <typename Lanes>
ORCHARD_INLINE void BoxList::insert_all(std::span<const BodyIndex> bodies, const BoxBlock& block,
                                        std::vector<BodyPair>& pairs) {
  const std::size_t groups = (filled_ + kGroup - 1) / kGroup;
  if (groups == 0) choose_scale(block, bodies.size());
  Group own;
  make_coarse(block, bodies.size(), own);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    std::array<std::uint64_t, 3> lower, upper;
    for (std::size_t d = 0; d < 3; ++d) lower[d] = own.lower[d][i] * kEachByte, upper[d] = own.upper[d][i] * kEachByte;
    // Of the block, those before it.
    const typename Lanes::Bits near = i == 0 ? Lanes::kNone : Lanes::before(Lanes::meeting(own, lower, upper), i);
    typename Lanes::Bits all = near;
    for (std::size_t g = 0; g < groups; ++g) Lanes::include(all, Lanes::meeting(groups_[g], lower, upper));
    if (!Lanes::any(all)) [[likely]]
      continue;
    const QuantizedAabb box = block.get(i);
    const auto compare = [&](BodyIndex other, const QuantizedAabb& with) {
      const bool exists = with.lower[0] <= with.upper[0];
      if (exists && with.meets(box)) pairs.push_back({std::min(bodies[i], other), std::max(bodies[i], other)});
    };
    for (std::size_t g = 0; g < groups; ++g) {
      for_each_hit(std::bit_cast<Words>(Lanes::meeting(groups_[g], lower, upper)), [&](std::size_t k) {
        if (kGroup * g + k < filled_) compare(static_cast<BodyIndex>(kGroup * g + k), boxes_[kGroup * g + k]);
      });
    }
    for_each_hit(std::bit_cast<Words>(near), [&](std::size_t k) { compare(bodies[k], block.get(k)); });
  }
  block.store(bodies, boxes_);
  put(bodies, own);
}

void BoxList::put(std::span<const BodyIndex> bodies, const Group& coarse) noexcept {
  for (const BodyIndex body : bodies) filled_ = std::max<std::size_t>(filled_, body + 1);
  const std::size_t first = bodies[0], last = first + bodies.size() - 1;
  constexpr std::size_t kFew = 8;  // that are not worth copying together
  if (bodies.size() < kFew || first / kGroup != last / kGroup || !successive(bodies)) {
    for (std::size_t i = 0; i < bodies.size(); ++i) groups_[bodies[i] / kGroup].set(bodies[i] % kGroup, coarse.get(i));
    return;
  }
  Group& group = groups_[first / kGroup];
  for (std::size_t d = 0; d < 3; ++d) {
    std::memcpy(&group.lower[d][first % kGroup], coarse.lower[d].data(), bodies.size());
    std::memcpy(&group.upper[d][first % kGroup], coarse.upper[d].data(), bodies.size());
  }
}

void BoxList::insert(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs) {
  const Machine chosen = machine();
  if (chosen == Machine::portable) return insert_all<PartLanes<std::uint64_t>>(bodies, block, pairs);
#if defined(ORCHARD_MACHINES)
  switch (chosen) {
    case Machine::avx512:
      return work_with_avx512([&]() ORCHARD_INLINE_LAMBDA { insert_all<PartLanes<EightWords>>(bodies, block, pairs); });
    case Machine::avx2:
      return work_with_avx2([&]() ORCHARD_INLINE_LAMBDA { insert_all<PartLanes<FourWords>>(bodies, block, pairs); });
    default:
      return insert_all<PartLanes<TwoWords>>(bodies, block, pairs);
  }
#elif defined(ORCHARD_VECTORS) && defined(__AVX512BW__)
  insert_all<PartLanes<EightWords>>(bodies, block, pairs);
#elif defined(ORCHARD_VECTORS) && (defined(__AVX2__) || defined(__aarch64__))
  insert_all<PartLanes<FourWords>>(bodies, block, pairs);
#else
  insert_all<PartLanes<std::uint64_t>>(bodies, block, pairs);
#endif
}

}  // namespace orchard::runtime::detail
