#include "broad_phase/sorted_spheres.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../runtime/every_machine.h"
#include "../support/effort.h"
#include "broad_phase/window_plan.h"
#include "oracles.h"
#include "orchard/runtime/broad_queries.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Worlds in which no bound lasts for longer than a step.
namespace orchard::runtime {
namespace {

constexpr std::uint64_t kSphereSeeds = 40;
using test::kStep;

struct Shape {
  const char* name;
  std::size_t bodies;
  double size, min_radius, max_radius, far;  // positions lie within `size` of (far, -far, far), along each axis
  double flat = 1;                           // of `size`, along z
};

constexpr Shape kShapes[] = {{"sparse", 300, 100, 0.5, 1.5, 0},
                             {"dense", 500, 4, 0.5, 0.5, 0},
                             {"flat", 400, 20, 0.1, 1, 0, 0},
                             {"points", 300, 1e-3, 0, 0, 0},
                             {"points and large ones", 300, 10, 0, 6, 0},
                             {"very small", 300, 1e-90, 1e-92, 1e-91, 0},
                             {"very large", 300, 1e90, 1e88, 1e89, 0},
                             {"far away", 300, 10, 0.5, 1, 1e9},
                             {"farther than the grid", 300, 1e12, 1e-3, 1e-2, 1e15}};

// Squares make most radii small; some bodies are where another one is, or lie somewhere else altogether.
std::vector<Motion> bodies_of(const Shape& shape, test::Draw& draw) {
  std::vector<Motion> motions(shape.bodies);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    Motion& m = motions[i];
    const double r = draw.uniform(0, 1);
    m.radius = shape.min_radius + r * r * (shape.max_radius - shape.min_radius);
    const auto off = [&] { return draw.uniform(-shape.size, shape.size); };
    m.position = {shape.far + off(), -shape.far + off(), shape.far + shape.flat * off()};
    if (i > 0 && draw.uniform(0, 1) < 0.1) m.position = motions[draw.bits() % i].position;
    if (draw.uniform(0, 1) < 0.02) m.position = 1e4 * m.position;
  }
  return motions;
}

std::vector<BodyPair> sorted(std::span<const BodyPair> pairs) {
  std::vector<BodyPair> result(pairs.begin(), pairs.end());
  std::sort(result.begin(), result.end());
  return result;
}

TEST(SortedSpheres, FindEachPairThatTouchesOnceOnEveryMachine) {
  const std::uint64_t first = orchard::test::first_seed();
  for (const Shape& shape : kShapes) {
    for (std::uint64_t seed = first; seed < first + kSphereSeeds * orchard::test::more(); ++seed) {
      test::Draw draw(seed);
      detail::SortedSpheres spheres;
      for (int step = 0; step < 3; ++step) {  // the cells of the first one stay
        const std::vector<Motion> motions = bodies_of(shape, draw);
        std::vector<BodyIndex> ids(motions.size());
        for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<BodyIndex>(i);
        const std::vector<BodyPair> expected = test::touching_pairs(motions);
        const auto check = [&] {
          spheres.begin(ids.size(), motions[0].position, step == 1 ? shape.size / 8 : 0);
          for (std::size_t i = 0; i < ids.size(); i += detail::kBlock) {
            const std::size_t count = std::min(detail::kBlock, ids.size() - i);
            spheres.add(std::span(ids).subspan(i, count), std::span(motions).subspan(i, count));
          }
          ASSERT_EQ(sorted(spheres.find()), expected) << shape.name << ", seed " << seed << ", step " << step;
        };
        test::on_every_machine(check);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

// Bounds are all void at each step for a while, then last, and then they are void again.
TEST(RestlessWorlds, ReportWhatBruteForceSaysAndAnswerQueries) {
  const std::uint64_t first = orchard::test::first_seed();
  for (std::uint64_t seed = first; seed < first + 12 * orchard::test::more(); ++seed) {
    test::Draw draw(seed);
    const Shape& shape = kShapes[seed % 3];
    std::vector<Motion> values = bodies_of(shape, draw);
    BroadPhase world(values_of(values), {.time_step = kStep});
    BodyQueries queries(world);
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < values.size(); ++i) ids.push_back(world.add());
    for (int step = 0; step < 60; ++step) {
      if (step / 20 != 1) {
        values = bodies_of(shape, draw);
        for (const BodyId id : ids) world.cancel(id);
      }
      const Advance now = world.advance(step * kStep);
      const std::vector<BodyPair> expected = test::touching_pairs(values);
      ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected) << "seed " << seed << ' ' << step;
      const Vec3 center = values[draw.bits() % values.size()].position;
      const double radius = draw.uniform(0, shape.size / 4);
      std::vector<BodyIndex> near;
      Motion sphere;
      sphere.position = center, sphere.radius = radius;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (spheres_touch(sphere, values[i])) near.push_back(static_cast<BodyIndex>(i));
      }
      const auto found = queries.touching_sphere(center, radius);
      ASSERT_EQ(std::vector<BodyIndex>(found.begin(), found.end()), near) << "seed " << seed << ' ' << step;
      ASSERT_EQ(queries.nearest(center, 3).size(), 3u);
    }
  }
}

// No more is asked than at each step once, and a sample for the plan, and what lasts again is asked as seldom as ever.
TEST(RestlessWorlds, AskOncePerStepAndSleepAgainLater) {
  test::Draw draw(1);
  std::vector<Motion> values = bodies_of({"resting", 1000, 40, 0.1, 0.2, 0}, draw);
  BroadPhase world(values_of(values), {.time_step = kStep});
  std::vector<BodyId> ids;
  for (std::size_t i = 0; i < values.size(); ++i) ids.push_back(world.add());
  world.advance(0);
  const std::uint64_t first = world.motions_asked();
  for (int step = 1; step <= 50; ++step) {
    for (const BodyId id : ids) world.cancel(id);
    world.advance(step * kStep);
  }
  const std::uint64_t restless = world.motions_asked() - first;
  EXPECT_LE(restless, 50 * (values.size() + detail::kSample) + values.size());
  for (int step = 51; step <= 150; ++step) world.advance(step * kStep);
  const std::uint64_t before = world.motions_asked();
  for (int step = 151; step <= 400; ++step) world.advance(step * kStep);
  EXPECT_LE(world.motions_asked() - before, 10 * values.size());
}

}  // namespace
}  // namespace orchard::runtime
