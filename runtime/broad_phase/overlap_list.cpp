#include "broad_phase/overlap_list.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kFewPairs = 64;
constexpr std::size_t kPairsWithRoom = 16;  // for each body

// Looks pairs up that come in ascending order.
class Finder {
 public:
  explicit Finder(const std::vector<BodyPair>& sorted)
      : begin_(sorted.data()), next_(begin_), end_(begin_ + sorted.size()) {}
  bool has(const BodyPair& pair) {
    next_ = std::lower_bound(next_, end_, pair);
    return next_ != end_ && *next_ == pair;
  }
  std::uint32_t place() const { return static_cast<std::uint32_t>(next_ - begin_); }  // it has, or would have, there

 private:
  const BodyPair *begin_, *next_, *end_;
};

}  // namespace

void OverlapList::sort(std::vector<BodyPair>& pairs, std::size_t slots, std::vector<BodyPair>& room) {
  // For very many, room for as many more would be too much.
  const std::size_t count = pairs.size();
  const bool few = 2 * count < slots || count < kFewPairs;
  const bool many = count > kPairsWithRoom * slots;
  if (few || many) return std::sort(pairs.begin(), pairs.end());
  room.resize(pairs.size());
  sort_by_body(pairs, room, slots, &BodyPair::b);
  sort_by_body(room, pairs, slots, &BodyPair::a);
}

// Those of one body stay in the order in which they come.
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

// Both sorted. Leaves what is added and not in the list, and what is dropped and in it, and says where.
void OverlapList::keep_changes() {
  Finder touching(added_), in_list(pairs_), in_list_too(pairs_);
  const auto keep = [](std::vector<BodyPair>& pairs, std::vector<std::uint32_t>& places, const Finder& finder,
                       const auto& counts) {
    places.clear();
    std::size_t kept = 0;
    for (const BodyPair pair : pairs) {
      if (!counts(pair)) continue;
      pairs[kept++] = pair;
      places.push_back(finder.place());
    }
    pairs.resize(kept);
  };
  keep(dropped_, dropped_places_, in_list,
       [&](const BodyPair& pair) { return !touching.has(pair) && in_list.has(pair); });
  keep(added_, added_places_, in_list_too, [&](const BodyPair& pair) { return !in_list_too.has(pair); });
}

void OverlapList::remove_dropped() {
  const auto begin = pairs_.begin();
  auto to = begin + dropped_places_.front(), from = to;
  for (const std::uint32_t place : dropped_places_) {
    to = std::move(from, begin + place, to);
    from = begin + place + 1;
  }
  pairs_.erase(std::move(from, pairs_.end(), to), pairs_.end());
}

// From the end: each part of the list moves once.
void OverlapList::insert_added() {
  auto from = pairs_.size();
  grow(pairs_, from + added_.size());
  auto to = pairs_.size();
  auto dropped = dropped_places_.size();  // before the place
  for (auto k = added_.size(); k > 0; --k) {
    const auto begin = pairs_.begin();
    while (dropped > 0 && dropped_places_[dropped - 1] >= added_places_[k - 1]) --dropped;
    const std::size_t place = added_places_[k - 1] - dropped;
    std::move_backward(begin + static_cast<std::ptrdiff_t>(place), begin + static_cast<std::ptrdiff_t>(from),
                       begin + static_cast<std::ptrdiff_t>(to));
    to -= from - place + 1;
    from = place;
    pairs_[to] = added_[k - 1];
  }
}

void OverlapList::update(std::size_t slots) {
  if (first_marked_ <= last_marked_) {
    forget_marked();
    clear_marks();
  }
  if (from_scratch_) {
    sort(pairs_, slots, added_);  // where nothing is
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  } else if (!added_.empty() || !dropped_.empty()) {
    sort(added_, slots, room_);
    added_.erase(std::unique(added_.begin(), added_.end()), added_.end());
    sort(dropped_, slots, room_);
    dropped_.erase(std::unique(dropped_.begin(), dropped_.end()), dropped_.end());
    keep_changes();
    if (!dropped_.empty()) remove_dropped();
    if (!added_.empty()) insert_added();
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
  return bytes_of(pairs_, added_, dropped_, marks_, begins_, room_, added_places_, dropped_places_);
}

}  // namespace orchard::runtime::detail
