#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "orchard/geometry/mesh.h"

// Reads small text formats line by line.
namespace orchard {

// A reader of lines. Blank lines, lines that start with '#', and the unread rest of a line are skipped. Every failure
// throws InputError, which names the file and the line. A copy of a reader continues at the position of the original,
// independently of it.
class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& file);
  TextLines(std::string name, std::string text);

  // Advances to the next line with contents. Returns false at the end.
  bool next();
  // Advances to the next line, which must start with `word`.
  void expect(std::string_view word);
  Index index();  // Reads a whole number, at least 0.
  // Reads a whole number of either sign.
  std::int64_t whole();
  // Reads a finite number. `what` is the name of the number in the error message.
  double real(std::string_view what = "a number");
  // Reads a finite number if the next word is one, and returns whether it is. Otherwise the position does not change.
  bool real_if_any(double& value);
  // Reads a whole number, at least 0, from this line or from the next one with contents.
  Index index_on_any_line(std::string_view what);
  // Returns the next word of the line, which ends at a blank; empty at the end of the line. The result is valid as long
  // as this object.
  std::string_view word();
  void skip_line() { at_ = line_end_; }  // Skips the rest of the line.
  // Reads the rest of the line if it consists of whole numbers only and these fit into `numbers`. Returns how many
  // there are. Otherwise returns 0, and the position does not change.
  std::size_t whole_numbers_to_the_end(std::span<std::int64_t> numbers);
  // Throws InputError, which names the file and the line.
  [[noreturn]] void fail(const std::string& fault) const;

 private:
  std::string_view line() const { return std::string_view(text_).substr(at_, line_end_ - at_); }
  void skip_space();
  template <class Scan, class Number>
  bool scan(Scan&& number, Number& value);
  [[noreturn]] void fail_to_find(std::string_view what) const;

  std::string name_, text_;
  // Positions in text_. Views would refer to the text of the original after a copy. next_ is the start of the next
  // line; at_ to line_end_ is the unread rest of this one.
  std::size_t next_ = 0, at_ = 0, line_end_ = 0;
  std::size_t line_number_ = 0;
};

// Appends a space and the fewest digits that read back as the same value.
void append_number(std::string& text, double value);
void append_number(std::string& text, Index value);

}  // namespace orchard
