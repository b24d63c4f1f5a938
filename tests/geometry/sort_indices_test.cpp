#include "query/sort_indices.h"  // private

#include <gtest/gtest.h>

#include "orchard/geometry/random.h"
#include "support/effort.h"

namespace orchard {
namespace {

TEST(SortIndices, OrdersNumbersOfEverySizeAndHoweverMany) {
  for (std::uint64_t k = 0; k < 40 * test::more(); ++k) {
    Random random(test::first_seed() + k, 11);
    const std::size_t count = random.below(k % 2 == 0 ? 6000 : 1100);
    const std::uint64_t below = std::uint64_t{1} << (1 + random.below(32));
    std::vector<Index> numbers(count);
    for (Index& number : numbers) number = static_cast<Index>(random.below(below));
    if (k % 5 == 0) std::fill(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count / 2), Index{7});
    std::vector<Index> expected = numbers;
    std::sort(expected.begin(), expected.end());
    detail::sort_indices(numbers);
    EXPECT_EQ(numbers, expected) << count << " numbers below " << below;
  }
  for (const Index last : {(Index{1} << 22) - 1, Index{1} << 22}) {  // where one way ends and the other begins
    std::vector<Index> numbers(2000, 5);
    numbers[3] = last;
    detail::sort_indices(numbers);
    EXPECT_EQ(numbers.back(), last);
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
  }
}

}  // namespace
}  // namespace orchard
