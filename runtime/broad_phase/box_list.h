#pragma once
#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"

namespace orchard::runtime::detail {

// The boxes of a few bodies in a list: each is compared with all others, coarsely, 64 at once, and what seems to meet
// exactly. Up to a hundred bodies or two that takes less time than finding cells.
class BoxList {
 public:
  static constexpr std::size_t kMaxBodies = 192;
  static constexpr std::size_t kAtOnce = 32;  // that insert() takes at most: of so few, room for more would be much

  void reset(std::size_t slots);  // empties the list; bodies are below
  void grow(std::size_t slots);   // keeps what is in it
  void release() { give_back(boxes_), give_back(groups_); }
  // Adds bodies[i] with block's box i and appends the pairs whose boxes meet, of each of them and everything in before.
  void insert(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs);
  void append_meeting(const QuantizedAabb& box, std::vector<BodyIndex>& bodies) const;  // those whose boxes meet it
  void remove(BodyIndex body) noexcept {
    boxes_[body] = kNowhere;
    groups_[body / kGroup].set(body % kGroup, kCoarseNowhere);
  }
  std::size_t slots() const noexcept { return boxes_.size(); }
  std::size_t memory_bytes() const noexcept { return bytes_of(boxes_) + bytes_of(groups_); }

 private:
  static constexpr std::size_t kGroup = 64;
  static constexpr std::uint8_t kLastCoarse = 0x7f, kHighBit = 0x80;
  // Meets nothing but what covers all quanta, since its lower ends lie above its upper ends.
  static constexpr QuantizedAabb kNowhere = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};
  struct CoarseBox {
    std::array<std::uint8_t, 3> lower, upper;
  };
  static constexpr CoarseBox kCoarseNowhere = {{kLastCoarse, kLastCoarse, kLastCoarse}, {kHighBit, kHighBit, kHighBit}};
  // Boxes in seven bits a coordinate, rounded outward, and what is too far away as if it were at the end. The eighth
  // bits of upper ends are set: subtracting a lower end, eight bytes as one number, leaves them where the one is not
  // below the other, and takes nothing from the next byte.
  using Bytes = std::array<std::uint8_t, kGroup>;
  using Words = std::array<std::uint64_t, kGroup / 8>;
  struct alignas(64) Group {
    std::array<Bytes, 3> lower, upper;
    void set(std::size_t i, const CoarseBox& box) noexcept {
      for (std::size_t d = 0; d < 3; ++d) lower[d][i] = box.lower[d], upper[d][i] = box.upper[d];
    }
    CoarseBox get(std::size_t i) const noexcept {
      return {{lower[0][i], lower[1][i], lower[2][i]}, {upper[0][i], upper[1][i], upper[2][i]}};
    }
  };
  template <typename Part>
  struct PartLanes;

  void choose_scale(const BoxBlock& block, std::size_t count) noexcept;
  void make_coarse(const BoxBlock& block, std::size_t count, Group& group) const noexcept;
  void put(std::span<const BodyIndex> bodies, const Group& coarse) noexcept;
  template <typename Use>
  static void for_each_hit(const Words& words, const Use& use);
  template <typename Lanes>
  void insert_all(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs);

  std::vector<QuantizedAabb> boxes_;      // by body
  std::vector<Group> groups_;             // the same
  std::size_t filled_ = 0;                // bodies are below
  unsigned shift_ = 0;                    // quanta to a coarse coordinate: 2^shift_
  std::array<std::uint32_t, 3> first_{};  // at which coarse coordinates begin
};

}  // namespace orchard::runtime::detail
