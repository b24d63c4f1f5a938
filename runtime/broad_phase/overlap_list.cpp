#include "broad_phase/overlap_list.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kFewPairs = 64;
constexpr std::size_t kPairsWithRoom = 16;  // per body

}  // namespace

void OverlapList::sort(std::vector<BodyPair>& pairs, std::size_t slots, std::vector<BodyPair>& room) {
  // A copy of very many pairs would take too much memory.
  const std::size_t count = pairs.size();
  const bool few = 2 * count < slots || count < kFewPairs;
  const bool many = count > kPairsWithRoom * slots;
  if (few || many) return std::sort(pairs.begin(), pairs.end());
  room.resize(pairs.size());
  sort_by_body(pairs, room, slots, &BodyPair::b);
  sort_by_body(room, pairs, slots, &BodyPair::a);
}

// Sorts pairs by one of their bodies. Pairs of the same body stay in their order.
void OverlapList::sort_by_body(std::span<const BodyPair> from, std::span<BodyPair> to, std::size_t slots,
                               BodyIndex BodyPair::*body) {
  begins_.assign(slots + 2, 0);
  for (const BodyPair& pair : from) ++begins_[pair.*body + 2];
  for (std::size_t i = 1; i <= slots; ++i) begins_[i + 1] += begins_[i];
  for (const BodyPair& pair : from) to[begins_[pair.*body + 1]++] = pair;
}

void OverlapList::clear_marks() noexcept {
  if (first_marked_ <= last_marked_) {
    std::fill(marks_.begin() + first_marked_, marks_.begin() + last_marked_ + 1, std::uint8_t{0});
  }
  first_marked_ = kNoIndex;
  last_marked_ = 0;
  refuses_ = false;
}

void OverlapList::forget_marked() {
  const auto marked = [&](const BodyPair& pair) { return (marks_[pair.a] | marks_[pair.b]) != 0; };
  const auto refused = [&](const BodyPair& pair) { return ((marks_[pair.a] | marks_[pair.b]) & kRefused) != 0; };
  if (!from_scratch_) std::erase_if(pairs_, marked);
  if (refuses_) std::erase_if(from_scratch_ ? pairs_ : added_, refused);
}

void OverlapList::start_over(std::span<const BodyPair> pairs) {
  pairs_.assign(pairs.begin(), pairs.end());
  added_.clear();
  clear_marks();
  from_scratch_ = true;
}

// Applies added_ and dropped_, which are sorted, to the list. It proceeds from the end, so that each part of the list
// moves once, and what lies before all changes does not move.
void OverlapList::apply_changes() {
  const std::size_t count = pairs_.size();
  grow(pairs_, count + added_.size());
  const auto begin = pairs_.begin();
  auto from = begin + static_cast<std::ptrdiff_t>(count), to = pairs_.end();
  auto added = added_.end(), dropped = dropped_.end();
  while (added != added_.begin() || dropped != dropped_.begin()) {
    const bool adds = dropped == dropped_.begin() || (added != added_.begin() && !(added[-1] < dropped[-1]));
    const BodyPair pair = adds ? *--added : *--dropped;
    if (adds && dropped != dropped_.begin() && dropped[-1] == pair) --dropped;  // it touches, so it stays
    const auto after = std::upper_bound(begin, from, pair);
    to = to == from ? after : std::move_backward(after, from, to);
    from = after;
    if (from != begin && from[-1] == pair) --from;
    if (adds) *--to = pair;
  }
  pairs_.erase(from, to);
}

void OverlapList::update(std::size_t slots) {
  if (first_marked_ <= last_marked_) {
    forget_marked();
    clear_marks();
  }
  if (from_scratch_) {
    sort(pairs_, slots, added_);  // which is empty, so it can be scratch
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  } else if (!added_.empty() || !dropped_.empty()) {
    sort(added_, slots, room_);
    added_.erase(std::unique(added_.begin(), added_.end()), added_.end());
    sort(dropped_, slots, room_);
    dropped_.erase(std::unique(dropped_.begin(), dropped_.end()), dropped_.end());
    apply_changes();
  }
  added_.clear();
  dropped_.clear();
  from_scratch_ = false;
}

void OverlapList::clear() noexcept {
  pairs_.clear();
  added_.clear();
  dropped_.clear();
  from_scratch_ = false;
  clear_marks();
}

std::size_t OverlapList::memory_bytes() const noexcept {
  return bytes_of(pairs_, added_, dropped_, marks_, begins_, room_);
}

}  // namespace orchard::runtime::detail
