#include "orchard/geometry/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include "orchard/geometry/error.h"
#include "text_scan.h"

namespace orchard {
namespace {

std::string read_text(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) throw InputError(file.string() + ": is a directory, not a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": cannot be opened");
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (in.bad()) throw InputError(file.string() + ": cannot be read");
  return text;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

TextLines::TextLines(const std::filesystem::path& file) : TextLines(file.string(), read_text(file)) {}
TextLines::TextLines(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {}

void TextLines::fail(const std::string& fault) const {
  throw InputError(name_ + ", line " + std::to_string(line_number_) + ": " + fault);
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

template <class Number>
Number TextLines::number(const char* what) {
  skip_space();
  Number value{};
  const std::string_view rest = line();
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc()) fail("expected " + std::string(what) + " at " + in_quotes(rest));
  at_ += static_cast<std::size_t>(end - rest.data());
  return value;
}

std::size_t TextLines::whole_numbers_to_the_end(std::span<std::int64_t> numbers) {
  const std::size_t start = at_;
  std::size_t count = 0;
  for (skip_space(); at_ < line_end_; skip_space()) {
    const std::string_view rest = line();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    const std::size_t length = static_cast<std::size_t>(end - rest.data());
    if (error != std::errc() || count == numbers.size() || (length < rest.size() && !is_space(rest[length]))) {
      at_ = start;
      return 0;
    }
    numbers[count++] = value;
    at_ += length;
  }
  return count;
}

Index TextLines::index() { return number<Index>("a whole number"); }
std::int64_t TextLines::whole() { return number<std::int64_t>("a whole number"); }
double TextLines::real() {
  const double value = number<double>("a number");
  if (!std::isfinite(value)) fail("a number that is not finite");
  return value;
}

void append_number(std::string& text, double value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  (void)error;  // 32 characters hold every double
  text += ' ';
  text.append(digits, end);
}

void append_number(std::string& text, Index value) { text += ' ' + std::to_string(value); }

}  // namespace orchard
