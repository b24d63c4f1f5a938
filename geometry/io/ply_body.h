#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "ply_header.h"
#include "text_scan.h"

namespace orchard {

// Reads the numbers of a PLY file's body one after another, in each encoding. If they cannot be read, InputError names
// the line (ASCII) or the byte (binary).

// Numbers as text, separated by white space.
class AsciiBody {
 public:
  AsciiBody(std::string_view bytes, std::size_t body, const std::string& name)
      : bytes_(bytes), name_(name), at_(bytes.data() + body), end_(bytes.data() + bytes.size()) {}

  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  // Returns the position of the next number.
  std::size_t position() {
    skip_space();
    return bytes_.size() - remaining();
  }
  [[noreturn]] void fail(std::size_t position, const std::string& fault) const {
    fail_at_line(name_, bytes_, position, fault);
  }
  // Names a position for a report.
  std::string place(std::size_t position) const { return line_place(bytes_, position); }
  double number(PlyType) {
    const char* token = next_token();
    double value = 0;
    if (!scan_any_double(at_, end_, value) || !at_token_end()) fail_not_a_number(token);
    return value;
  }
  std::int64_t integer(PlyType) {
    const char* token = next_token();
    std::int64_t value = 0;
    if (scan_integer(at_, end_, value) && at_token_end()) return value;
    at_ = token;  // it may be written as 3.0
    const double real = number(PlyType::float64);
    if (!(std::abs(real) < 0x1p53) || real != std::floor(real)) {
      fail(static_cast<std::size_t>(token - bytes_.data()), "the length or an index of a list is not an integer");
    }
    return static_cast<std::int64_t>(real);
  }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) {
      next_token();
      while (!at_token_end()) ++at_;
    }
  }
  static std::size_t min_bytes(PlyType) { return 1; }

 private:
  bool at_token_end() const { return at_ == end_ || is_blank(*at_) || is_line_end(*at_); }
  void skip_space() {
    while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
  }
  const char* next_token() {
    skip_space();
    if (at_ == end_) fail(bytes_.size(), "the file ends before the rows that its header promises; it may be cut off");
    return at_;
  }
  [[noreturn]] void fail_not_a_number(const char* token) {
    at_ = token;
    while (!at_token_end()) ++at_;
    fail(static_cast<std::size_t>(token - bytes_.data()), in_quotes({token, at_}) + " is not a number");
  }

  std::string_view bytes_;
  const std::string& name_;
  const char* at_;
  const char* end_;
};

template <typename T>
T byte_swapped(T value) {
  std::array<unsigned char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
  std::memcpy(&value, raw.data(), sizeof(T));
  return value;
}

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, std::size_t body, std::endian order, const std::string& name)
      : bytes_(bytes), name_(name), at_(body), swap_(order != std::endian::native) {}

  std::size_t remaining() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }
  [[noreturn]] void fail(std::size_t position, const std::string& fault) const { fail_at_byte(name_, position, fault); }
  static std::string place(std::size_t position) { return "byte " + std::to_string(position); }
  double number(PlyType type) {
    return visit<double>(type, [](auto value) { return static_cast<double>(value); });
  }
  std::int64_t integer(PlyType type) {
    const std::size_t start = at_;
    return visit<std::int64_t>(type, [&](auto value) {
      if constexpr (std::is_floating_point_v<decltype(value)>) {
        if (!(std::abs(value) < 0x1p53) || value != std::floor(value)) {
          fail(start, "the length or an index of a list is not an integer");
        }
      }
      return static_cast<std::int64_t>(value);
    });
  }
  void skip(PlyType type, std::uint64_t count) {
    if (count > remaining() / size_of(type))
      fail(bytes_.size(), "the file ends before the rows that its header promises; it may be cut off");
    at_ += count * size_of(type);
  }
  static std::size_t min_bytes(PlyType type) { return size_of(type); }

 private:
  template <typename T>
  T take() {
    if (remaining() < sizeof(T))
      fail(bytes_.size(), "the file ends before the rows that its header promises; it may be cut off");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return swap_ ? byte_swapped(value) : value;
  }
  template <typename Result, typename Function>
  Result visit(PlyType type, const Function& function) {
    switch (type) {
      case PlyType::int8:
        return function(take<std::int8_t>());
      case PlyType::uint8:
        return function(take<std::uint8_t>());
      case PlyType::int16:
        return function(take<std::int16_t>());
      case PlyType::uint16:
        return function(take<std::uint16_t>());
      case PlyType::int32:
        return function(take<std::int32_t>());
      case PlyType::uint32:
        return function(take<std::uint32_t>());
      case PlyType::float32:
        return function(take<float>());
      case PlyType::float64:
        break;
    }
    return function(take<double>());
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_;
  bool swap_;
};

}  // namespace orchard
