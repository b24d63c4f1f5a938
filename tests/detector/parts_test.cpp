#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "orchard/runtime/detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

namespace orchard::runtime {
namespace {

using test::Draw;
using Touching = std::set<std::pair<std::size_t, std::size_t>>;

using test::kStep;

struct Part {
  std::size_t shape;
  Pose local;
  bool moves;
};

// Long ones, flat ones, and a tree with a dent.
std::vector<ShapeId> add_shapes(Detector& world) {
  static const PackedSphereTree beam = test::build_tree(test::box({0, -0.1, -0.1}, {2, 0.1, 0.1}));
  static const PackedSphereTree corner = test::build_tree(test::scaled(test::l_shape(), 0.3));
  return {world.add_shape(beam), world.add_shape(corner), world.add_capsule({-1, 0, 0}, {1, 0.5, 0}, 0.1),
          world.add_box({1, 0.8, 0.05}), world.add_sphere(0.3)};
}

Pose drawn(Draw& draw, double distance) { return draw.pose(distance * draw.uniform(0, 1)); }

Touching found(const Frame& frame, const std::vector<std::size_t>& body_of) {
  Touching result;
  for (const PairEvent& event : frame.events) {
    if (event.verdict.answer != Answer::yes) continue;
    const auto [a, b] = std::minmax(body_of[event.a.index], body_of[event.b.index]);
    if (a != b) result.insert({a, b});
  }
  return result;
}

// The same parts, some at a time on bodies, and each as a body of its own.
TEST(Parts, TouchWhatTheyWouldAsBodiesOfTheirOwn) {
  constexpr std::size_t kBodies = 10;
  constexpr int kSteps = 30;
  std::size_t touching = 0;
  const std::uint64_t first = orchard::test::first_seed(), count = 20 * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Draw draw(seed);
    std::vector<BodyState> states(kBodies), own_states;
    Detector world(states_of(states), {.time_step = kStep, .watch = false}),
        own(states_of(own_states), {.time_step = kStep});
    const std::vector<ShapeId> shapes = add_shapes(world);
    EXPECT_EQ(add_shapes(own), shapes);
    std::vector<std::vector<Part>> bodies(kBodies);
    std::vector<Vec3> places, ways;
    std::vector<std::size_t> same, owner;
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < kBodies; ++i) {
      std::vector<BodyPart> parts;
      for (int k = static_cast<int>(draw.uniform(1, 5)); k > 0; --k) {
        const auto shape = static_cast<std::size_t>(draw.uniform(0, 5));
        bodies[i].push_back({shape, drawn(draw, 2), draw.uniform(0, 1) < 0.4});
        parts.push_back({shapes[shape], bodies[i].back().local});
        own.add_body({{shapes[shape]}});
        owner.push_back(i);
      }
      ids.push_back(world.add_body(parts));
      same.push_back(i);
      states[i].pose = drawn(draw, 5);
      ways.push_back(draw.uniform(0, 0.05) * Vec3(draw.direction()));
    }
    own_states.resize(owner.size());
    for (int step = 0; step < kSteps; ++step) {
      std::size_t next = 0;
      for (std::size_t i = 0; i < kBodies; ++i) {
        states[i].pose.translation = Vec3(states[i].pose.translation) + ways[i];
        states[i].expiry = step * kStep;
        for (std::size_t k = 0; k < bodies[i].size(); ++k) {
          Part& part = bodies[i][k];
          if (part.moves && step % 3 != 0) {
            part.local = *made_rigid(compose(part.local, draw.pose(0.02)));
            ASSERT_TRUE(world.set_local(ids[i], k, part.local));
          }
          own_states[next].pose = made_rigid(compose(states[i].pose, part.local)).value();
          own_states[next++].expiry = step * kStep;
        }
      }
      const Touching together = found(world.step(step * kStep), same), apart = found(own.step(step * kStep), owner);
      EXPECT_EQ(together, apart) << seed << ' ' << step;
      touching += together.size();
    }
  }
  EXPECT_GT(touching, 1000u);
}

}  // namespace
}  // namespace orchard::runtime
