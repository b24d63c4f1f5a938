#pragma once
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include "orchard/geometry/error.h"

namespace orchard {

inline bool is_line_end(char c) { return c == '\n' || c == '\r'; }
inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

// Returns the number of the line, counted from 1, that contains `offset`. Lines end with \n, \r\n or \r.
std::size_t line_number(std::string_view bytes, std::size_t offset);

// Returns the same as text for a report: "line 7".
std::string line_place(std::string_view bytes, std::size_t offset);

// Returns `text` in quotes, cut to a length and to characters that are suitable for a message.
std::string in_quotes(std::string_view text);

[[noreturn]] void fail_at_line(const std::string& name, std::string_view bytes, std::size_t offset,
                               const std::string& fault);
[[noreturn]] void fail_at_byte(const std::string& name, std::size_t offset, const std::string& fault);

// Whether a well-formed decimal number that does not fit into a double is too small rather than too large.
bool is_tiny(std::string_view number);

// Reads the number at `at` and moves `at` past it. All forms of C are accepted, with an optional plus sign and also
// "inf" and "nan", whatever the locale. Returns false and leaves `at` unmoved if there is none or if it is too large.
inline bool scan_double(const char*& at, const char* end, double& value) {
  const char* first = at;
  if (first != end && *first == '+' && first + 1 != end && first[1] != '-') ++first;
  const auto [stop, error] = std::from_chars(first, end, value);
  if (error == std::errc::result_out_of_range) {
    if (!is_tiny({first, stop})) return false;
    value = 0;
  } else if (error != std::errc()) {
    return false;
  }
  at = stop;
  return true;
}

// Does the same, but reads a number that is too large for a double as infinite.
inline bool scan_any_double(const char*& at, const char* end, double& value) {
  if (scan_double(at, end, value)) return true;
  const char* first = at;
  if (first != end && *first == '+' && first + 1 != end && first[1] != '-') ++first;
  double unused = 0;
  const auto [stop, error] = std::from_chars(first, end, unused);
  if (error != std::errc::result_out_of_range) return false;
  value = *first == '-' ? -HUGE_VAL : HUGE_VAL;
  at = stop;
  return true;
}

inline bool scan_integer(const char*& at, const char* end, std::int64_t& value) {
  const char* first = at;
  if (first != end && *first == '+' && first + 1 != end && first[1] != '-') ++first;
  const auto [stop, error] = std::from_chars(first, end, value);
  if (error != std::errc()) return false;
  at = stop;
  return true;
}

}  // namespace orchard
