#pragma once
#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

// The bodies that are new, or gone, or whose bounds hold no longer, since the last step: each once, as they came.
class Changes {
 public:
  void make_room(std::size_t slots) { grow(pending_, slots); }
  void note(BodyIndex body) {  // there is room for it
    if (pending_[body]) return;
    changed_.push_back(body);
    pending_[body] = 1;
  }
  bool has(BodyIndex body) const noexcept { return pending_[body] != 0; }
  const std::uint8_t* at(BodyIndex body) const noexcept { return &pending_[body]; }  // to load it ahead
  bool empty() const noexcept { return changed_.empty(); }
  std::size_t size() const noexcept { return changed_.size(); }  // at most
  void append_to(std::vector<BodyIndex>& bodies) const {
    for (const BodyIndex body : changed_) {
      if (pending_[body]) bodies.push_back(body);
    }
  }
  // Each leaves, and is used; load(body) is called some bodies ahead.
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
  static constexpr std::size_t kKept = 1024;  // room for as many stays allocated, not what adding all bodies took

  std::vector<std::uint8_t> pending_;  // by body
  std::vector<BodyIndex> changed_;
};

}  // namespace orchard::runtime::detail
