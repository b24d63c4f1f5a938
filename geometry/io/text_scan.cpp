#include "text_scan.h"

#include <algorithm>

namespace orchard {

std::size_t line_number(std::string_view bytes, std::size_t offset) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < std::min(offset, bytes.size()); ++i) {
    const bool pair = bytes[i] == '\r' && i + 1 < bytes.size() && bytes[i + 1] == '\n';
    line += is_line_end(bytes[i]) && !pair;
  }
  return line;
}

std::string line_place(std::string_view bytes, std::size_t offset) {
  return "line " + std::to_string(line_number(bytes, offset));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLength = 24;
  std::string result = "\"";
  for (const char c : text.substr(0, kLength)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLength ? "...\"" : "\"");
}

void fail_at_line(const std::string& name, std::string_view bytes, std::size_t offset, const std::string& fault) {
  throw InputError(name + ", line " + std::to_string(line_number(bytes, offset)) + ": " + fault);
}

void fail_at_byte(const std::string& name, std::size_t offset, const std::string& fault) {
  throw InputError(name + ", byte " + std::to_string(offset) + ": " + fault);
}

bool is_tiny(std::string_view number) {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  // The decimal order of the first digit that is not zero.
  const auto point = static_cast<std::ptrdiff_t>(std::min(digits.find('.'), digits.size()));
  const auto first = static_cast<std::ptrdiff_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  const std::ptrdiff_t order = first < point ? point - first : point - first + 1;
  if (exponent_at == number.size()) return order < 0;
  std::int64_t exponent = 0;
  const char* at = number.data() + exponent_at + 1;
  if (scan_integer(at, number.data() + number.size(), exponent)) {
    // Both are bounded by the memory and by 64 bits. They are compared without adding, which might overflow.
    return exponent < -order;
  }
  return number.substr(exponent_at + 1).starts_with('-');  // the exponent does not fit into 64 bits
}

}  // namespace orchard
