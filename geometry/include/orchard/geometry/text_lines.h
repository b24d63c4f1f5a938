#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Reads small text formats line by line. Blank lines and lines that start with '#' are skipped, and so is what is left
// on a line when the next one is asked for. Everything that cannot be read throws InputError, which names file and
// line. A copy, or what a value is moved to, reads on by itself from where the other was.
class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& file);
  TextLines(std::string name, std::string text);

  bool next();                         // goes to the next line that holds anything; false at the end
  void expect(std::string_view word);  // the next line, which must start with this word
  Index index();                       // a whole number, 0 or more
  std::int64_t whole();
  double real(std::string_view what = "a number");  // finite; `what` names it in the message if there is none
  // The same if there is a number next on the line. Returns whether there is; otherwise the line stays where it is.
  bool real_if_any(double& value);
  // A whole number, 0 or more, on this line or the next one that has anything left.
  Index index_on_any_line(std::string_view what);
  // The next word of the line, which blanks end; empty at the end of the line. Valid as long as this value.
  std::string_view word();
  void skip_line() { at_ = line_end_; }  // what is left of it
  // What is left of the line, if it is nothing but whole numbers and no more of them than `numbers` has room for: how
  // many they are. Otherwise 0, and the line stays where it is.
  std::size_t whole_numbers_to_the_end(std::span<std::int64_t> numbers);
  [[noreturn]] void fail(const std::string& fault) const;

 private:
  std::string_view line() const { return std::string_view(text_).substr(at_, line_end_ - at_); }
  void skip_space();
  template <class Scan, class Number>
  bool scan(Scan&& number, Number& value);
  [[noreturn]] void fail_to_find(std::string_view what) const;

  std::string name_, text_;
  // Places in text_ rather than views of it, which would stay with the text of the value that a copy was made of.
  std::size_t next_ = 0, at_ = 0, line_end_ = 0;  // where the next line begins; what is left of this one
  std::size_t line_number_ = 0;
};

// Appends a space and the fewest digits that read back as the same double.
void append_number(std::string& text, double value);
void append_number(std::string& text, Index value);

}  // namespace orchard
