#include "predicates/short_integer.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

#include "support/effort.h"

namespace orchard::detail {
namespace {

constexpr int kMostBits = 61;  // of a difference of short coordinates

// Of any number of bits up to that, most often near a power of two.
std::int64_t random_difference(std::mt19937_64& random) {
  const auto bits = static_cast<unsigned>(random() % (kMostBits + 1));
  const std::int64_t top = std::int64_t{1} << bits;
  const auto below = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(top));
  const std::int64_t magnitude = random() % 2 == 0 ? top - static_cast<std::int64_t>(random() % 2) : below;
  return random() % 2 == 0 ? magnitude : -magnitude;
}

// Sums of four products of the degree five, as the lifted determinant is, that nearly cancel: the words of several
// lengths against integers of any.
TEST(ShortIntegers, HaveTheSignsOfLongOnes) {
  std::mt19937_64 random(test::first_seed());
  int zero = 0, negative = 0, positive = 0;
  for (std::uint64_t round = 0; round < 20'000 * test::more(); ++round) {
    ShortInteger<5> short_sum{TwoWords(0)};
    ExactInteger long_sum = 0;
    for (int term = 0; term < 2; ++term) {
      const std::int64_t a = random_difference(random), b = random_difference(random), c = random_difference(random),
                         d = random_difference(random), e = random_difference(random);
      const ShortInteger<3> volume = ShortInteger<3>(TwoWords(a)) * ShortInteger<3>(TwoWords(b) * c);
      const ShortInteger<5> product = ShortInteger<5>(TwoWords(d) * e) * ShortInteger<5>(volume);
      const ExactInteger long_volume = ExactInteger(a) * b * c, long_product = long_volume * d * e;
      ASSERT_EQ(volume.sign(), long_volume.sign());
      ASSERT_EQ(product.sign(), long_product.sign());
      // Once more with the other sign, off by one at times.
      const std::int64_t off = static_cast<std::int64_t>(random() % 3) - 1;
      short_sum = (short_sum + product) - (product + ShortInteger<5>(TwoWords(off)));
      long_sum += long_product - (long_product + off);
      ASSERT_EQ(short_sum.sign(), long_sum.sign());
      ASSERT_EQ((short_sum * product).sign(), long_sum.sign() * long_product.sign());
    }
    ++(short_sum.sign() == 0 ? zero : short_sum.sign() < 0 ? negative : positive);
  }
  EXPECT_GT(zero, 1000);
  EXPECT_GT(negative, 1000);
  EXPECT_GT(positive, 1000);
}

}  // namespace
}  // namespace orchard::detail
