#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace orchard::apps {

// What a process prints, of which no more than the beginning and the end is kept: it may print for ever.
class BoundedText {
 public:
  // limit: bytes kept of the beginning, and as many of the end.
  explicit BoundedText(std::size_t limit) : limit_(limit) {}

  void add(std::string_view bytes) {
    const std::size_t room = limit_ - head_.size();
    head_ += bytes.substr(0, room);
    if (bytes.size() <= room) return;
    tail_ += bytes.substr(room);
    if (tail_.size() <= 2 * limit_) return;
    left_out_ += tail_.size() - limit_;
    tail_.erase(0, tail_.size() - limit_);
  }
  bool whole() const { return left_out_ == 0; }
  // With a line in place of what was left out.
  std::string text() const {
    return whole() ? head_ + tail_ : head_ + "\n.. " + std::to_string(left_out_) + " bytes ..\n" + tail_;
  }

 private:
  std::size_t limit_, left_out_ = 0;
  std::string head_, tail_;
};

}  // namespace orchard::apps
