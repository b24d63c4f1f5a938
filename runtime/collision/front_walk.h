#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "collision/kernels/front_block.h"
#include "collision/pair_query.h"
#include "orchard/runtime/pair_front.h"

namespace orchard::runtime {

// The last level of a NarrowPhase that begins where a front says, and leaves the front where it ends. It finds the
// same answer, since every two triangles that are not seen to be apart are tested by the same predicates.
class FrontWalk {
 public:
  // Precondition: the search is placed.
  FrontWalk(PairFront& front, DirectSearch& search) noexcept;

  // Before run(): whether the front is of these trees, and most of it still holds; it is brought up to now. Else
  // begin().
  bool resume() noexcept { return fits() && advance(); }
  void begin() noexcept;  // with the roots, of which nothing is known
  // Yes and no are said to `search`; where the budget ends it, the front knows how far it got.
  void run(const Budget& budget) noexcept;

 private:
  using Axis = std::array<float, 3>;
  enum class Outcome : std::uint8_t { apart, meeting, interrupted };

  bool fits() const noexcept;
  bool advance() noexcept;
  // Inline: in position-independent code compilers put nothing else into its caller.
  void see_to(std::uint32_t slot) noexcept {
    const detail::FrontBlock& block = front_.blocks_[slot / kBlockWidth];
    const std::uint32_t lane = slot % kBlockWidth;
    (is_leaf_pair(block.a[lane], block.b[lane]) ? leaves_ : nodes_).add(slot);
  }
  std::uint32_t block_count() const noexcept { return (front_.used_ + kBlockWidth - 1) / kBlockWidth; }
  bool is_leaf_pair(std::uint32_t a, std::uint32_t b) const noexcept {
    return (detail::slab_child(first_, a) & detail::slab_child(second_, b) & kLeafBit) != 0;
  }
  Outcome settle_leaves() noexcept;
  Outcome settle_nodes() noexcept;
  Outcome walk(const NodePair& from) noexcept;
  bool leaves_meet(const NodePair& pair, const Axis* last, detail::LeafAxis& axis) noexcept;
  void expand(const NodePair& pair, const detail::Opened& opened) noexcept;
  void add(std::uint32_t a, std::uint32_t b, float gap, const Axis& u) noexcept;
  void keep_stack() noexcept;
  void release(std::uint32_t slot) noexcept;

  PairFront& front_;
  DirectSearch& search_;
  const TreeView &first_, &second_;
  const detail::Placement& placement_;
  const Pose& relative_;
  PairBudget* tracker_ = nullptr;
  NodePair* stack_;
  std::size_t stack_size_ = 0;
  void note(float gap) noexcept { least_ = gap < least_ ? gap : least_; }

  float least_ = std::numeric_limits<float>::infinity();  // of the gaps that are known now
  float far_ = std::numeric_limits<float>::infinity();    // gaps above it are kept as one bound
  float enough_ = 0;                                      // of a gap between leaves: as much as the last motion
  struct Slots {
    std::array<std::uint16_t, PairFront::kRoom> slots;
    std::uint32_t count = 0;
    void add(std::uint32_t slot) noexcept { slots[count++] = static_cast<std::uint16_t>(slot); }
  };
  Slots leaves_, nodes_;  // without a gap
};

}  // namespace orchard::runtime
