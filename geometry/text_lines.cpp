#include "orchard/geometry/text_lines.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include "orchard/geometry/error.h"

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

}  // namespace

TextLines::TextLines(const std::filesystem::path& file) : TextLines(file.string(), read_text(file)) {}
TextLines::TextLines(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)), rest_(text_) {}

void TextLines::fail(const std::string& fault) const {
  throw InputError(name_ + ", line " + std::to_string(line_number_) + ": " + fault);
}

bool TextLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_number_;
    skip_space();
    if (!line_.empty() && line_[0] != '#') return true;
  }
  return false;
}

void TextLines::skip_space() {
  while (!line_.empty() && (line_[0] == ' ' || line_[0] == '\t' || line_[0] == '\r')) line_.remove_prefix(1);
}

void TextLines::expect(std::string_view word) {
  const std::string line = "a line that starts with \"" + std::string(word) + '"';
  if (!next()) fail("the file ends where it must have " + line + "; it may be cut off");
  if (!line_.starts_with(word)) fail("expected " + line);
  line_.remove_prefix(word.size());
}

template <class Number>
Number TextLines::number(const char* what) {
  skip_space();
  Number value{};
  const auto [end, error] = std::from_chars(line_.data(), line_.data() + line_.size(), value);
  if (error != std::errc()) fail("expected " + std::string(what) + " at \"" + std::string(line_.substr(0, 20)) + "\"");
  line_.remove_prefix(static_cast<std::size_t>(end - line_.data()));
  return value;
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
