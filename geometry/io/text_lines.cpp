#include "orchard/geometry/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "orchard/geometry/error.h"
#include "text_scan.h"

namespace orchard {
namespace {

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw InputError(file.string() + ": this is a folder; give a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": the file cannot be opened; check that it exists and its permissions");
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw InputError(file.string() + ": the file cannot be read; check the disk");
  return text;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

TextLines::TextLines(const std::filesystem::path& file) : TextLines(file.string(), read_text(file)) {}
TextLines::TextLines(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {}

void TextLines::fail(const std::string& fault) const {
  const std::string line = line_number_ > 0 ? ", line " + std::to_string(line_number_) : std::string();
  throw InputError(name_ + line + ": " + fault);
}

bool TextLines::next() {
  while (next_ < text_.size()) {
    at_ = next_;
    line_end_ = std::min(text_.find('\n', at_), text_.size());
    next_ = std::min(line_end_ + 1, text_.size());
    ++line_number_;
    skip_space();
    if (at_ < line_end_ && text_[at_] != '#') return true;
  }
  return false;
}

void TextLines::skip_space() {
  while (at_ < line_end_ && is_space(text_[at_])) ++at_;
}

void TextLines::expect(std::string_view word) {
  const std::string start = "a line that starts with \"" + std::string(word) + '"';
  if (!next()) fail("the file ends where it must have " + start + "; it may be cut off");
  if (!line().starts_with(word)) fail("expected " + start);
  at_ += word.size();
}

// Reads the next item on the line with one of the functions of text_scan.h.
template <class Scan, class Number>
bool TextLines::scan(Scan&& number, Number& value) {
  const std::string_view rest = line();
  const char* at = rest.data();
  const bool found = number(at, rest.data() + rest.size(), value);
  at_ += static_cast<std::size_t>(at - rest.data());
  return found;
}

void TextLines::fail_to_find(std::string_view what) const {
  fail("expected " + std::string(what) + " at " + (at_ < line_end_ ? in_quotes(line()) : "the end of the line"));
}

std::size_t TextLines::whole_numbers_to_the_end(std::span<std::int64_t> numbers) {
  const std::size_t start = at_;
  std::size_t count = 0;
  for (skip_space(); at_ < line_end_; skip_space()) {
    std::int64_t value = 0;
    const bool found = scan(scan_integer, value);
    if (!found || count == numbers.size() || (at_ < line_end_ && !is_space(text_[at_]))) {
      at_ = start;
      return 0;
    }
    numbers[count++] = value;
  }
  return count;
}

Index TextLines::index() {
  skip_space();
  const std::size_t start = at_;
  std::int64_t value = 0;
  if (scan(scan_integer, value) && value >= 0 && value <= std::numeric_limits<Index>::max())
    return static_cast<Index>(value);
  at_ = start;
  fail_to_find("a whole number");
}

std::int64_t TextLines::whole() {
  skip_space();
  std::int64_t value = 0;
  if (!scan(scan_integer, value)) fail_to_find("a whole number");
  return value;
}

double TextLines::real(std::string_view what) {
  skip_space();
  double value = 0;
  if (!scan(scan_double, value)) fail_to_find(what);
  if (!std::isfinite(value)) fail("the number is not finite");
  return value;
}

bool TextLines::real_if_any(double& value) {
  const std::size_t start = at_;
  skip_space();
  if (scan(scan_double, value) && std::isfinite(value)) return true;
  at_ = start;
  return false;
}

Index TextLines::index_on_any_line(std::string_view what) {
  skip_space();
  while (at_ >= line_end_) {
    if (!next()) fail("the file ends where it must have " + std::string(what) + "; it may be cut off");
  }
  const std::size_t start = at_;
  std::int64_t value = 0;
  if (scan(scan_integer, value) && value >= 0 && value <= std::numeric_limits<Index>::max())
    return static_cast<Index>(value);
  at_ = start;
  fail_to_find(what);
}

std::string_view TextLines::word() {
  skip_space();
  const std::size_t start = at_;
  while (at_ < line_end_ && !is_space(text_[at_])) ++at_;
  return std::string_view(text_).substr(start, at_ - start);
}

void append_number(std::string& text, double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  (void)error;  // 32 characters are enough for every double
  text += ' ';
  text.append(digits, end);
}

void append_number(std::string& text, Index value) { text += ' ' + std::to_string(value); }

}  // namespace orchard
