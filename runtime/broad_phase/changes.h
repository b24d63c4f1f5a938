#pragma once
#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

// The bodies that were added or removed, or whose bounds were cancelled, since the last step. Each occurs once, in the
// order of the changes.
class Changes {
 public:
  void make_room(std::size_t slots) { grow(pending_, slots); }
  void note(BodyIndex body) {  // after make_room()
    if (pending_[body]) return;
    changed_.push_back(body);
    pending_[body] = 1;
  }
  bool has(BodyIndex body) const noexcept { return pending_[body] != 0; }
  const std::uint8_t* at(BodyIndex body) const noexcept { return &pending_[body]; }  // for prefetching
  bool empty() const noexcept { return changed_.empty(); }
  std::size_t size() const noexcept { return changed_.size(); }
  void append_to(std::vector<BodyIndex>& bodies) const {
    for (const BodyIndex body : changed_) {
      if (pending_[body]) bodies.push_back(body);
    }
  }
  // Removes all bodies, and calls use(body) for each. load(body) is called some bodies ahead, for prefetching.
  template <typename Load, typename Use>
  void take(const Load& load, const Use& use) {
    constexpr std::size_t kAhead = 16;
    for (std::size_t i = 0; i < changed_.size(); ++i) {
      if (i + kAhead < changed_.size()) load(changed_[i + kAhead]);
      const BodyIndex body = changed_[i];
      if (!pending_[body]) continue;
      pending_[body] = 0;
      use(body);
    }
    changed_.clear();
    if (changed_.capacity() > kKept) give_back(changed_);
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(pending_, changed_); }

 private:
  static constexpr std::size_t kKept = 1024;  // more room than this, as after adding all bodies, is given back

  std::vector<std::uint8_t> pending_;  // by body
  std::vector<BodyIndex> changed_;
};

}  // namespace orchard::runtime::detail
