#include <gtest/gtest.h>

#include "orchard/runtime/broad_phase.h"
#include "runtime/numbers.h"

namespace orchard::runtime {
namespace {

using test::kStep;

// A lattice in which neighbours overlap: few bodies, and so many that they are in the grid.
TEST(BroadPhase, AsksBodiesAtRestOnceUntilTheyAreCancelled) {
  for (const std::size_t side : {5u, 8u}) {
    std::vector<Motion> values(side * side * side);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::size_t x = i % side, y = i / side % side, z = i / (side * side);
      values[i].position = 0.9 * Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
      values[i].radius = 0.5;
    }
    BroadPhase world(values_of(values), {.time_step = kStep});
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < values.size(); ++i) ids.push_back(world.add());
    const std::size_t lines = 3 * side * side * (side - 1);  // pairs of neighbours along an axis
    EXPECT_EQ(world.advance(0).pairs.size(), lines);
    const std::uint64_t asked = world.motions_asked();
    for (int step = 1; step < 2000; ++step) ASSERT_EQ(world.advance(kStep * step).pairs.size(), lines);
    EXPECT_EQ(world.motions_asked(), asked);

    values[0].velocity = {-1, -1, -1};  // a corner leaves its three neighbours
    world.cancel(ids[0]);
    std::size_t pairs = lines;
    for (int step = 2000; step < 2030; ++step) {
      pairs = world.advance(kStep * step).pairs.size();
      values[0].position = values[0].position + kStep * values[0].velocity;
    }
    EXPECT_EQ(pairs, lines - 3);
  }
}

}  // namespace
}  // namespace orchard::runtime
