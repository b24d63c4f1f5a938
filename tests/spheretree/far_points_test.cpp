#include "far_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "orchard/geometry/random.h"
#include "support/effort.h"

namespace orchard {
namespace {

using detail::FarPoints;
using detail::FourNumbers;

struct Numbers {
  std::vector<FourNumbers> fours;
  std::size_t count;
  double operator[](std::size_t i) const { return fours[i / FourNumbers::kLanes].numbers[i % FourNumbers::kLanes]; }
};

// Some are equal if there are few steps. The last group is filled up with the last number, as a fitter does it.
Numbers any_numbers(std::uint64_t seed) {
  Random random(seed, 6);
  const std::size_t count = 1 + random.below(400);
  const double steps = random.uniform() < 0.5 ? 5 : 1e6;
  Numbers numbers{std::vector<FourNumbers>((count + 3) / FourNumbers::kLanes), count};
  double last = 0;
  for (std::size_t i = 0; i < FourNumbers::kLanes * numbers.fours.size(); ++i) {
    if (i < count) last = std::floor(steps * random.uniform()) / steps;
    numbers.fours[i / FourNumbers::kLanes].numbers[i % FourNumbers::kLanes] = last;
  }
  return numbers;
}

TEST(FarPoints, AreTheFarthestOfThoseThatAreFar) {
  FarPoints far;
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 2000 * test::more(); ++seed) {
    const Numbers numbers = any_numbers(seed);
    const double min = Random(seed, 7).uniform(0, 0.6);
    far.take(numbers.fours, numbers.count, min, 1);
    std::multiset<double> expected, taken;
    for (std::size_t i = 0; i < numbers.count; ++i)
      if (numbers[i] >= min && numbers[i] > 0) expected.insert(numbers[i]);
    while (expected.size() > FarPoints::kMax) expected.erase(expected.begin());
    std::set<Index> points;
    for (std::size_t i = 0; i < far.count(); ++i) {
      taken.insert(far.squared(i));
      points.insert(far.point(i));
      ASSERT_LT(far.point(i), numbers.count) << seed;
      ASSERT_EQ(far.squared(i), numbers[far.point(i)]) << seed;
    }
    ASSERT_EQ(points.size(), far.count()) << seed;
    ASSERT_EQ(taken, expected) << seed;
  }
}

}  // namespace
}  // namespace orchard
