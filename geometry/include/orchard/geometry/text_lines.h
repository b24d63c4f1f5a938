#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Reads small text formats line by line. Blank lines and lines that start with '#' are skipped, and so is what is left
// on a line when the next one is asked for. Everything that cannot be read throws InputError, which names file and
// line.
class TextLines {
 public:
  explicit TextLines(const std::filesystem::path& file);
  TextLines(std::string name, std::string text);

  bool next();                         // goes to the next line that holds anything; false at the end
  void expect(std::string_view word);  // the next line, which must start with this word
  Index index();                       // a whole number, 0 or more
  std::int64_t whole();
  double real();  // finite
  [[noreturn]] void fail(const std::string& fault) const;

 private:
  void skip_space();
  template <class Number>
  Number number(const char* what);

  std::string name_, text_;
  std::string_view rest_, line_;
  std::size_t line_number_ = 0;
};

// Appends a space and the fewest digits that read back as the same double.
void append_number(std::string& text, double value);
void append_number(std::string& text, Index value);

}  // namespace orchard
