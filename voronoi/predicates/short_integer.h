#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "predicates/exact_integer.h"

// Integers of a few machine words. They give the exact signs of points whose differences have few digits, which is the
// case for most neighbours.
namespace orchard::detail {

#ifdef __SIZEOF_INT128__
__extension__ using TwoWords = __int128;
__extension__ using TwoUnsignedWords = unsigned __int128;

// An integer of kWords words in two's complement. Results are right if they fit.
template <std::size_t kWords>
class ShortInteger {
 public:
  ShortInteger() = default;
  explicit ShortInteger(TwoWords number) {
    word_[0] = static_cast<std::uint64_t>(number);
    word_[1] = static_cast<std::uint64_t>(number >> 64);
    extend(2);
  }
  template <std::size_t kFewer>
  explicit ShortInteger(const ShortInteger<kFewer>& number) {
    static_assert(kFewer < kWords);
    for (std::size_t i = 0; i < kFewer; ++i) word_[i] = number.word(i);
    extend(kFewer);
  }

  std::uint64_t word(std::size_t i) const { return word_[i]; }
  int sign() const {
    if (is_negative(kWords - 1)) return -1;
    std::uint64_t any = 0;
    for (const std::uint64_t word : word_) any |= word;
    return any != 0 ? 1 : 0;
  }

  friend ShortInteger operator+(const ShortInteger& a, const ShortInteger& b) { return sum(a, b, 0, 0); }
  friend ShortInteger operator-(const ShortInteger& a, const ShortInteger& b) {
    return sum(a, b, ~std::uint64_t{0}, 1);  // plus the complement plus one
  }
  friend ShortInteger operator*(const ShortInteger& a, const ShortInteger& b) {
    ShortInteger product;
    for (std::size_t i = 0; i < kWords; ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; i + j < kWords; ++j) {
        const TwoUnsignedWords next = TwoUnsignedWords{a.word_[i]} * b.word_[j] + product.word_[i + j] + carry;
        product.word_[i + j] = static_cast<std::uint64_t>(next);
        carry = static_cast<std::uint64_t>(next >> 64);
      }
    }
    return product;
  }

 private:
  static ShortInteger sum(const ShortInteger& a, const ShortInteger& b, std::uint64_t turn, std::uint64_t carry) {
    ShortInteger result;
    for (std::size_t i = 0; i < kWords; ++i) {
      const TwoUnsignedWords next = TwoUnsignedWords{a.word_[i]} + (b.word_[i] ^ turn) + carry;
      result.word_[i] = static_cast<std::uint64_t>(next);
      carry = static_cast<std::uint64_t>(next >> 64);
    }
    return result;
  }
  bool is_negative(std::size_t last) const { return (word_[last] >> 63) != 0; }
  void extend(std::size_t from) {
    const std::uint64_t fill = is_negative(from - 1) ? ~std::uint64_t{0} : 0;
    for (std::size_t i = from; i < kWords; ++i) word_[i] = fill;
  }

  std::array<std::uint64_t, kWords> word_{};
};

#else
using TwoWords = ExactInteger;
template <std::size_t kWords>
using ShortInteger = ExactInteger;
#endif

}  // namespace orchard::detail
