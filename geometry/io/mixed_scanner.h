#pragma once
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "text_scan.h"

namespace orchard {

// Reads words, numbers and binary values one after another, for formats that mix text and binary blocks. Messages name
// the line of a text and the byte of a binary file.
class MixedScanner {
 public:
  MixedScanner(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  void set_binary(std::endian order) {
    binary_ = true;
    swap_ = order != std::endian::native;
  }
  bool binary() const { return binary_; }
  std::size_t position() const { return at_; }
  void move_to(std::size_t position) { at_ = position; }
  std::size_t remaining() const { return bytes_.size() - at_; }

  [[noreturn]] void fail(std::size_t position, const std::string& fault) const {
    if (binary_) fail_at_byte(name_, position, fault);
    fail_at_line(name_, bytes_, position, fault);
  }
  [[noreturn]] void fail_at_end() const { fail(bytes_.size(), "the file ends early; it may be cut off"); }
  std::string place(std::size_t position) const {
    return binary_ ? "byte " + std::to_string(position) : line_place(bytes_, position);
  }

  // Skips blanks and line ends. Returns false at the end of the file.
  bool more() {
    while (at_ < bytes_.size() && (is_blank(bytes_[at_]) || is_line_end(bytes_[at_]))) ++at_;
    return at_ < bytes_.size();
  }
  // Does the same in a text only, because blanks in a binary file are values.
  void more_of_text() {
    if (!binary_) more();
  }
  // Returns the next word, on this line or a later one. Fails at the end of the file.
  std::string_view word() {
    if (!more()) fail_at_end();
    const std::size_t start = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_]) && !is_line_end(bytes_[at_])) ++at_;
    return bytes_.substr(start, at_ - start);
  }
  std::string_view peek() {
    const std::size_t start = at_;
    const std::string_view next = more() ? word() : std::string_view();
    at_ = start;
    return next;
  }
  // Returns the rest of the line and moves past its end, which is \n, \r\n or \r.
  std::string_view line() {
    const std::size_t start = at_;
    while (at_ < bytes_.size() && !is_line_end(bytes_[at_])) ++at_;
    const std::string_view rest = bytes_.substr(start, at_ - start);
    if (at_ < bytes_.size() && bytes_[at_++] == '\r' && at_ < bytes_.size() && bytes_[at_] == '\n') ++at_;
    return rest;
  }
  // Reads a number from text. It may be infinite or NaN.
  double number() {
    const std::string_view text = word();
    const char* at = text.data();
    double value = 0;
    if (!scan_any_double(at, text.data() + text.size(), value) || at != text.data() + text.size())
      fail(at_ - text.size(), in_quotes(text) + " is not a number");
    return value;
  }
  std::int64_t integer() {
    const std::string_view text = word();
    const char* at = text.data();
    std::int64_t value = 0;
    if (!scan_integer(at, text.data() + text.size(), value) || at != text.data() + text.size())
      fail(at_ - text.size(), in_quotes(text) + " is not an integer");
    return value;
  }
  // Reads a binary value.
  template <typename T>
  T raw() {
    if (remaining() < sizeof(T)) fail_at_end();
    const T value = value_at<T>(bytes_.data() + at_, swap_);
    at_ += sizeof(T);
    return value;
  }
  // Reads a value from the bytes at `data`. `swap` means that they are in the other byte order than the machine's.
  template <typename T>
  static T value_at(const char* data, bool swap) {
    char own[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) own[i] = data[swap ? sizeof(T) - 1 - i : i];
    T value;
    std::memcpy(&value, own, sizeof(T));
    return value;
  }
  void skip(std::uint64_t count) {
    if (count > remaining()) fail_at_end();
    at_ += count;
  }

  // Returns a number of items that follow. It is refused if the file is too short for them, at `bytes_each` or more for
  // each.
  std::uint64_t checked_count(std::int64_t count, std::size_t bytes_each, const char* items) const {
    if (count < 0) fail(at_, "there is a negative number of " + std::string(items));
    if (static_cast<std::uint64_t>(count) > (remaining() + 1) / bytes_each)
      fail(at_, std::to_string(count) + " " + items + " are promised, but only " + std::to_string(remaining()) +
                    " bytes follow; the file is cut short or not of this format");
    return static_cast<std::uint64_t>(count);
  }

 private:
  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  bool binary_ = false, swap_ = false;
};

}  // namespace orchard
