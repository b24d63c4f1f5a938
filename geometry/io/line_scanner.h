#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "text_scan.h"

namespace orchard {

// The lines of a text, split into words.
class LineScanner {
 public:
  // `comment`: the character that starts a comment, which runs to the end of the line; 0 if the format has none.
  LineScanner(std::string_view bytes, std::size_t at, char comment, const std::string& name)
      : bytes_(bytes), name_(name), comment_(comment), next_(at) {}

  // Moves to the next line that has a word. Returns false at the end of the text.
  bool next() {
    while (next_ < bytes_.size()) {
      start_ = next_;
      const std::size_t stop = std::min(bytes_.find_first_of("\r\n", next_), bytes_.size());
      next_ = stop + 1;
      std::string_view line = bytes_.substr(start_, stop - start_);
      if (comment_ != 0) line = line.substr(0, line.find(comment_));
      at_ = line.data();
      end_ = line.data() + line.size();
      skip_blanks();
      if (at_ != end_) return true;
    }
    return false;
  }
  // Whether another word follows. If it is on a later line, moves there.
  bool more() { return more_on_line() || next(); }
  bool more_on_line() const { return at_ != end_; }
  std::size_t start() const { return start_; }
  std::size_t left() const { return bytes_.size() - start_; }
  std::string_view rest_of_line() const { return {at_, static_cast<std::size_t>(end_ - at_)}; }
  [[noreturn]] void fail(const std::string& fault) const { fail_at_line(name_, bytes_, start_, fault); }

  // Returns the next word of the line and moves past it; an empty one if there is none.
  std::string_view word() {
    const std::string_view result = peek();
    at_ += result.size();
    skip_blanks();
    return result;
  }
  // Returns the next word of the line without moving.
  std::string_view peek() const {
    const char* stop = at_;
    while (stop != end_ && !is_blank(*stop)) ++stop;
    return {at_, static_cast<std::size_t>(stop - at_)};
  }
  // Reads the next word as a finite number and moves past it. Returns nothing, and does not move, if it is none.
  std::optional<double> number() {
    const std::optional<double> value = number_or_none();
    return value && std::isfinite(*value) ? value : std::nullopt;
  }
  // Reads three numbers, which need not be finite.
  std::array<double, 3> point() {
    std::array<double, 3> result;
    for (double& coordinate : result) {
      const std::optional<double> value = number_or_none();
      if (!value) fail("a vertex needs three finite numbers");
      coordinate = *value;
    }
    return result;
  }
  std::optional<std::uint64_t> count() {
    std::int64_t value = 0;
    const char* first = at_;
    if (!scan_integer(at_, end_, value) || !word_ended() || value < 0) {
      at_ = first;
      return std::nullopt;
    }
    skip_blanks();
    return static_cast<std::uint64_t>(value);
  }

 private:
  // The next word as a number: infinite if it is too large for a double, nothing if the word is no number.
  std::optional<double> number_or_none() {
    double value = 0;
    const char* first = at_;
    if (!scan_any_double(at_, end_, value) || !word_ended()) {
      at_ = first;
      return std::nullopt;
    }
    skip_blanks();
    return value;
  }
  bool word_ended() const { return at_ == end_ || is_blank(*at_); }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }

  std::string_view bytes_;
  const std::string& name_;
  char comment_;
  std::size_t next_ = 0, start_ = 0;
  const char* at_ = nullptr;
  const char* end_ = nullptr;
};

// Appends a number with the fewest digits that read back as the same number.
template <typename Number>
void append_digits(std::string& text, Number value) {
  std::array<char, 32> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

inline void append_point(std::string& text, const std::array<double, 3>& point) {
  for (const double coordinate : point) append_digits(text += ' ', coordinate);
  text += '\n';
}

}  // namespace orchard
