#pragma once
#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

// The list of the pairs that overlap at the last processed step, in ascending order, as it is reported. It is kept from
// step to step: a step adds and drops pairs that it has tested, and all other pairs stay.
class OverlapList {
 public:
  // Marks of a body, which change all of its pairs.
  static constexpr std::uint8_t kUpdated = 1;  // its pairs leave the list, except those that the step adds
  static constexpr std::uint8_t kRefused = 2;  // all its pairs leave the list, even those that the step adds

  std::span<const BodyPair> pairs() const noexcept { return pairs_; }

  // The changes of the step under way, in any order and with repetitions. A pair that is added and dropped stays.
  void add(const BodyPair& pair) { append(from_scratch_ ? pairs_ : added_, pair); }
  void drop(const BodyPair& pair) { dropped_.push_back(pair); }
  void make_room(std::size_t slots) { grow(marks_, slots); }  // for marks of bodies below `slots`
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
  // Replaces the list by these pairs, in any order. Until the end of the step, pairs can be added, and kUpdated and
  // drop() have no effect.
  void start_over(std::span<const BodyPair> pairs = {});
  // Moves the pairs for which leaves(pair) is true from the list to `taken`, immediately.
  template <typename Leaves>
  void take_out(const Leaves& leaves, std::vector<BodyPair>& taken) {
    std::erase_if(pairs_, [&](const BodyPair& pair) {
      const bool out = leaves(pair);
      if (out) taken.push_back(pair);
      return out;
    });
  }
  // Ends the step: applies all changes since the last call to the list. `slots` is above all indices of bodies.
  // O(changes), and O(pairs) if there are any.
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
  std::vector<std::uint32_t> begins_;  // by body: scratch for sorting many pairs
  std::vector<BodyPair> room_;         // scratch for sorting the changes
};

}  // namespace orchard::runtime::detail
