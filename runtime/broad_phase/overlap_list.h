#pragma once
#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

// The pairs that overlap at the step processed last, in ascending order, as they are reported. It lasts from step to
// step: a step says which pairs it has tested and which of these touch, and pairs that were not tested stay.
class OverlapList {
 public:
  // What a step does to a body's pairs.
  static constexpr std::uint8_t kUpdated = 1;  // all that are in the list are void: those that still touch are added
  static constexpr std::uint8_t kRefused = 2;  // it is in no pair, whatever was added

  std::span<const BodyPair> pairs() const noexcept { return pairs_; }

  // Of the step under way, in any order, any number of times.
  void add(const BodyPair& pair) { append(from_scratch_ ? pairs_ : added_, pair); }  // it touches
  void drop(const BodyPair& pair) { dropped_.push_back(pair); }  // it does not, unless it is added, too
  void make_room(std::size_t slots) { grow(marks_, slots); }     // bodies that are marked are below
  void mark(BodyIndex body, std::uint8_t what) noexcept {
    if (from_scratch_ && what == kUpdated) return;
    marks_[body] |= what;
    first_marked_ = std::min(first_marked_, body);
    last_marked_ = std::max(last_marked_, body);
    refuses_ = refuses_ || what == kRefused;
  }
  void mark_updated(std::span<const BodyIndex> bodies) noexcept {
    if (from_scratch_) return;
    std::uint8_t* const marks = marks_.data();
    BodyIndex first = first_marked_, last = last_marked_;
    for (const BodyIndex body : bodies) {
      marks[body] |= kUpdated;
      first = std::min(first, body), last = std::max(last, body);
    }
    first_marked_ = first, last_marked_ = last;
  }
  // Until the end of the step nothing counts but these, in any order, and what is added from now on.
  void start_over(std::span<const BodyPair> pairs = {});
  // Moves the pairs for which it holds out of the list, at once.
  template <typename Leaves>
  void take_out(const Leaves& leaves, std::vector<BodyPair>& taken) {
    std::erase_if(pairs_, [&](const BodyPair& pair) {
      const bool out = leaves(pair);
      if (out) taken.push_back(pair);
      return out;
    });
  }
  // Ends the step, with so many slots of bodies: all that was said since the last end becomes the list. O(what was
  // said), and O(pairs) if that changes anything.
  void update(std::size_t slots);
  void clear() noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  void sort(std::vector<BodyPair>& pairs, std::size_t slots, std::vector<BodyPair>& room);
  void sort_by_body(std::span<const BodyPair> from, std::span<BodyPair> to, std::size_t slots,
                    BodyIndex BodyPair::*body);
  void forget_marked();
  void clear_marks() noexcept;
  void apply_changes();

  std::vector<BodyPair> pairs_, added_, dropped_;
  std::vector<std::uint8_t> marks_;  // by body
  BodyIndex first_marked_ = kNoIndex, last_marked_ = 0;
  bool from_scratch_ = false, refuses_ = false;
  std::vector<std::uint32_t> begins_;  // by body, while many pairs are sorted
  std::vector<BodyPair> room_;         // while some are; changes
};

}  // namespace orchard::runtime::detail
