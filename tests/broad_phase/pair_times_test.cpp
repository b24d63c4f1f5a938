#include "broad_phase/horn.h"

#include <gtest/gtest.h>

#include <bit>

#include "../runtime/every_machine.h"
#include "../support/effort.h"
#include "simd/machine.h"
#include "worlds.h"

namespace orchard::runtime {
namespace {

using namespace detail;

constexpr double kResolution = 1e-3;

// BoundedPairs close to each other and far apart, at rest and fast, with and without each of the bounds.
Motion any_motion(test::Draw& draw, double scale) {
  const auto mostly = [&](double x) { return draw.uniform(0, 1) < 0.3 ? 0 : x; };
  Motion m;
  m.position = scale * draw.in_ball(mostly(draw.uniform(0, 4)));
  m.velocity = scale * mostly(draw.uniform(0, 10)) * draw.direction();
  m.radius = scale * mostly(draw.uniform(0, 2));
  m.acceleration = scale * mostly(draw.uniform(0, 10));
  m.drift = scale * mostly(draw.uniform(0, 1));
  if (draw.uniform(0, 1) < 0.1) m.half_space = draw.uniform(0, 3) * draw.direction();
  return m;
}

struct BoundedPairs {
  std::vector<Motion> motions;
  std::vector<double> limits;
};

BoundedPairs any_pairs(test::Draw& draw) {
  BoundedPairs pairs;
  const double scale = std::ldexp(1, static_cast<int>(draw.bits() % 80) - 40);
  pairs.limits.resize(1 + draw.bits() % kPairsAtOnce);
  for (double& limit : pairs.limits) {
    limit = draw.uniform(0, 1) < 0.2 ? 0 : draw.uniform(0, 2);
    pairs.motions.push_back(any_motion(draw, scale));
    pairs.motions.push_back(draw.uniform(0, 1) < 0.05 ? pairs.motions.back() : any_motion(draw, scale));
  }
  return pairs;
}

PairTimes times_of(const BoundedPairs& pairs, double slack) {
  PairTimes times{};
  EXPECT_TRUE(find_pair_times(pairs.motions, pairs.limits, {kResolution, slack}, times));
  return times;
}

TEST(PairTimes, AreTheSameForFourAtOnceAsOneByOne) {
  test::Draw draw(orchard::test::first_seed());
  for (std::uint64_t round = 0; round < 2000 * orchard::test::more(); ++round) {
    const BoundedPairs pairs = any_pairs(draw);
    const double slack = draw.uniform(0, 1) < 0.5 ? 0 : draw.uniform(0, 0.1);
    PairTimes expected{};
    {
      const test::OnMachine one_by_one(Machine::portable);
      expected = times_of(pairs, slack);
    }
    const auto check = [&] {
      const PairTimes times = times_of(pairs, slack);
      for (std::size_t i = 0; i < pairs.limits.size(); ++i) {
        const Motion &a = pairs.motions[2 * i], &b = pairs.motions[2 * i + 1];
        ASSERT_EQ(times.touching[i], spheres_touch(a, b));
        ASSERT_EQ(std::bit_cast<std::uint64_t>(times.seconds[i]), std::bit_cast<std::uint64_t>(expected.seconds[i]))
            << round << ": pair " << i << ": " << times.seconds[i] << ", not " << expected.seconds[i];
        if (times.touching[i]) continue;
        ASSERT_EQ(times.seconds[i], earliest_contact(a, b, pairs.limits[i], kResolution, slack));
      }
    };
    test::on_every_machine(check);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(PairTimes, AreNotTakenOfMotionsThatAreNotValid) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  test::on_every_machine([] {
    test::Draw draw(5);
    for (int round = 0; round < 2000; ++round) {
      BoundedPairs pairs = any_pairs(draw);
      Motion& bad = pairs.motions[draw.bits() % pairs.motions.size()];
      const double wrong = std::array{kNaN, kInfinite, -kInfinite, 1e101, -1e101}[draw.bits() % 5];
      switch (draw.bits() % 7) {
        case 0:
          bad.position[draw.bits() % 3] = wrong;
          break;
        case 1:
          bad.velocity[draw.bits() % 3] = wrong;
          break;
        case 2:
          bad.half_space[draw.bits() % 3] = wrong;
          break;
        case 3:
          bad.radius = draw.bits() % 2 ? wrong : -1;
          break;
        case 4:
          bad.acceleration = draw.bits() % 2 ? wrong : -1;
          break;
        case 5:
          bad.drift = draw.bits() % 2 ? wrong : -1;
          break;
        default:
          bad.expiry = kNaN;
      }
      ASSERT_FALSE(is_valid(bad));
      PairTimes times{};
      EXPECT_FALSE(find_pair_times(pairs.motions, pairs.limits, {kResolution, 0}, times));
    }
  });
}

}  // namespace
}  // namespace orchard::runtime
