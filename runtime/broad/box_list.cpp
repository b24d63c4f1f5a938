#include "box_list.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "../machine.h"
#include "../vector_support.h"

namespace orchard::runtime::detail {

// Sixteen boxes of a Group or a BoxBlock against one box. Quanta are below 2^31: lane i of apart() is negative where
// box first + i does not meet it.
struct BoxList::PlainLanes {
  using Words = std::array<std::uint32_t, kGroup>;
  static constexpr Words kAllApart = [] {
    Words words{};
    words.fill(~0u);
    return words;
  }();
  template <typename Boxes>
  static Words apart(const Boxes& boxes, std::size_t first, const QuantumBox& box) noexcept {
    Words words{};
    for (std::size_t i = 0; i < kGroup; ++i) {
      for (std::size_t d = 0; d < 3; ++d) {
        words[i] |= (boxes.upper[d][first + i] - box.lower[d]) | (box.upper[d] - boxes.lower[d][first + i]);
      }
    }
    return words;
  }
  static Words before(const Words& apart, std::size_t end) noexcept {  // those from `end` on are apart
    Words words = apart;
    for (std::size_t i = end; i < kGroup; ++i) words[i] = ~0u;
    return words;
  }
  static Words both(const Words& a, const Words& b) noexcept {
    Words words{};
    for (std::size_t i = 0; i < kGroup; ++i) words[i] = a[i] & b[i];
    return words;
  }
  static std::uint32_t meeting(const Words& apart) noexcept {  // bit i: they meet
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kGroup; ++i) bits |= (~apart[i] >> 31) << i;
    return bits;
  }
};

#ifdef ORCHARD_VECTORS
struct BoxList::VectorLanes {
  using Words __attribute__((vector_size(64))) = std::uint32_t;
  using Half __attribute__((vector_size(32))) = std::uint64_t;
  static constexpr Words kAllApart = ~Words{};
  ORCHARD_INLINE static Words at(const std::uint32_t* from) noexcept {
    Words result;
    std::memcpy(&result, from, sizeof result);
    return result;
  }
  template <typename Boxes>
  ORCHARD_INLINE static Words apart(const Boxes& boxes, std::size_t first, const QuantumBox& box) noexcept {
    Words words{};
    for (std::size_t d = 0; d < 3; ++d) {  // numbers are spread
      words |= at(boxes.upper[d].data() + first) - box.lower[d];
      words |= box.upper[d] - at(boxes.lower[d].data() + first);
    }
    return words;
  }
  ORCHARD_INLINE static Words before(const Words& apart, std::size_t end) noexcept {
    const Words lanes = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    return apart | reinterpret_cast<Words>(lanes >= static_cast<std::uint32_t>(end));
  }
  ORCHARD_INLINE static Words both(const Words& a, const Words& b) noexcept { return a & b; }
  ORCHARD_INLINE static std::uint32_t meeting(const Words& apart) noexcept {
    const Words meet = (~apart >> 31) << Words{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const auto parts = std::bit_cast<std::array<Half, 2>>(meet);
    const Half sum = parts[0] | parts[1];
    const std::uint64_t all = (sum[0] | sum[1]) | (sum[2] | sum[3]);
    return static_cast<std::uint32_t>(all | all >> 32);
  }
};
#endif

#ifdef ORCHARD_VECTORS
// The same as two vectors of eight, for machines that have no wider ones: of the others GCC keeps parts in memory.
struct BoxList::HalvesLanes {
  using Eight __attribute__((vector_size(32))) = std::uint32_t;
  using Signed __attribute__((vector_size(32))) = std::int32_t;
  using Four __attribute__((vector_size(32))) = std::uint64_t;
  struct Words {
    Eight low, high;
  };
  static constexpr Words kAllApart = {~Eight{}, ~Eight{}};
  template <typename Boxes>
  ORCHARD_INLINE static Eight eight_apart(const Boxes& boxes, std::size_t first, const QuantumBox& box) noexcept {
    Eight words{};
    for (std::size_t d = 0; d < 3; ++d) {  // numbers are spread
      words |= at(boxes.upper[d].data() + first) - box.lower[d];
      words |= box.upper[d] - at(boxes.lower[d].data() + first);
    }
    return words;
  }
  template <typename Boxes>
  ORCHARD_INLINE static Words apart(const Boxes& boxes, std::size_t first, const QuantumBox& box) noexcept {
    return {eight_apart(boxes, first, box), eight_apart(boxes, first + 8, box)};
  }
  ORCHARD_INLINE static Words before(const Words& apart, std::size_t end) noexcept {
    const auto last = static_cast<std::uint32_t>(end) - 1;  // what lies beyond gives a negative difference
    const Eight low = {0, 1, 2, 3, 4, 5, 6, 7};
    return {apart.low | (last - low), apart.high | (last - (low + 8))};
  }
  ORCHARD_INLINE static Words both(const Words& a, const Words& b) noexcept { return {a.low & b.low, a.high & b.high}; }
  ORCHARD_INLINE static std::uint32_t meeting(const Words& apart) noexcept {
    const Signed low = reinterpret_cast<Signed>(~apart.low) >> 31, high = reinterpret_cast<Signed>(~apart.high) >> 31;
    const Signed bits = {1, 2, 4, 8, 16, 32, 64, 128};
    const Four met = reinterpret_cast<Four>((low & bits) | (high & (bits << 8)));
    const std::uint64_t all = (met[0] | met[1]) | (met[2] | met[3]);
    return static_cast<std::uint32_t>(all | all >> 32);
  }

 private:
  ORCHARD_INLINE static Eight at(const std::uint32_t* from) noexcept {
    Eight result;
    std::memcpy(&result, from, sizeof result);
    return result;
  }
};
#endif

void BoxList::reset(std::size_t slots) {
  groups_.clear();
  filled_ = 0;
  grow(slots);
}

void BoxList::grow(std::size_t slots) {
  if (slots <= this->slots()) return;
  Group empty;
  for (std::size_t d = 0; d < 3; ++d) empty.lower[d].fill(kNowhere.lower[d]), empty.upper[d].fill(kNowhere.upper[d]);
  groups_.resize((slots + kGroup - 1) / kGroup, empty);
}

void BoxList::set(BodyIndex body, const QuantumBox& box) noexcept {
  Group& group = groups_[body / kGroup];
  for (std::size_t d = 0; d < 3; ++d) {
    group.lower[d][body % kGroup] = box.lower[d];
    group.upper[d][body % kGroup] = box.upper[d];
  }
}

void BoxList::append_meeting(const QuantumBox& box, std::vector<BodyIndex>& bodies) const {
  for (std::size_t g = 0; g * kGroup < filled_; ++g) {
    for (std::uint32_t hits = PlainLanes::meeting(PlainLanes::apart(groups_[g], 0, box)); hits != 0; hits &= hits - 1) {
      bodies.push_back(static_cast<BodyIndex>(kGroup * g + static_cast<std::size_t>(std::countr_zero(hits))));
    }
  }
}

// Mostly a box meets none: that is found out about all of them together.
template <typename Lanes>
ORCHARD_INLINE void BoxList::insert_all(std::span<const BodyIndex> bodies, const BoxBlock& block,
                                        std::vector<BodyPair>& pairs) {
  const auto found = [&](BodyIndex a, BodyIndex b) { pairs.push_back(a < b ? BodyPair{a, b} : BodyPair{b, a}); };
  const std::size_t groups = (filled_ + kGroup - 1) / kGroup;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const QuantumBox box = block.get(i);
    typename Lanes::Words apart = Lanes::kAllApart;
    for (std::size_t g = 0; g < groups; ++g) apart = Lanes::both(apart, Lanes::apart(groups_[g], 0, box));
    std::size_t first = 0;  // of the block, those before it
    for (; first + kGroup <= i; first += kGroup) apart = Lanes::both(apart, Lanes::apart(block, first, box));
    apart = Lanes::both(apart, Lanes::before(Lanes::apart(block, first, box), i - first));
    if (Lanes::meeting(apart) == 0) [[likely]]
      continue;
    for (std::size_t g = 0; g < groups; ++g) {
      for (std::uint32_t hits = Lanes::meeting(Lanes::apart(groups_[g], 0, box)); hits != 0; hits &= hits - 1) {
        found(bodies[i], static_cast<BodyIndex>(kGroup * g + static_cast<std::size_t>(std::countr_zero(hits))));
      }
    }
    for (std::size_t part = 0; part <= first; part += kGroup) {
      const auto meeting = Lanes::before(Lanes::apart(block, part, box), std::min(kGroup, i - part));
      for (std::uint32_t hits = Lanes::meeting(meeting); hits != 0; hits &= hits - 1) {
        found(bodies[i], bodies[part + static_cast<std::size_t>(std::countr_zero(hits))]);
      }
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    set(bodies[i], block.get(i));
    filled_ = std::max<std::size_t>(filled_, bodies[i] + 1);
  }
}

void BoxList::insert_plain(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs) {
  insert_all<PlainLanes>(bodies, block, pairs);
}

void BoxList::insert_vectors(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs) {
#if defined(ORCHARD_MACHINES)
  switch (machine()) {
    case Machine::avx512:
      return work_with_avx512([&]() ORCHARD_INLINE_LAMBDA { insert_all<VectorLanes>(bodies, block, pairs); });
    case Machine::avx2:
      return work_with_avx2([&]() ORCHARD_INLINE_LAMBDA { insert_all<HalvesLanes>(bodies, block, pairs); });
    default:  // compilers make better vectors of four of it than of vectors of eight
      return insert_all<PlainLanes>(bodies, block, pairs);
  }
#elif defined(ORCHARD_VECTORS) && defined(__AVX512BW__)
  insert_all<VectorLanes>(bodies, block, pairs);
#elif defined(ORCHARD_VECTORS) && (defined(__AVX2__) || defined(__aarch64__))
  insert_all<HalvesLanes>(bodies, block, pairs);
#else
  insert_all<PlainLanes>(bodies, block, pairs);
#endif
}

void BoxList::insert(std::span<const BodyIndex> bodies, const BoxBlock& block, bool vectors,
                     std::vector<BodyPair>& pairs) {
  vectors ? insert_vectors(bodies, block, pairs) : insert_plain(bodies, block, pairs);
}

}  // namespace orchard::runtime::detail
