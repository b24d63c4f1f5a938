#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace orchard::apps {

// The output of a process, which may be infinite. Only its beginning and its end are kept.
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
  // Returns the text, with a line in place of the part that was dropped.
  std::string text() const {
    return whole() ? head_ + tail_ : head_ + "\n.. " + std::to_string(left_out_) + " bytes ..\n" + tail_;
  }

 private:
  std::size_t limit_, left_out_ = 0;
  std::string head_, tail_;
};

}  // namespace orchard::apps
