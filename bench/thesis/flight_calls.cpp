#include "flight_calls.h"

#include "scene.h"

namespace orchard::bench {

std::vector<Query> flight_calls(const runtime::TreeView& tree, std::size_t count, std::uint64_t seed) {
  constexpr int kControlSteps = 40;  // for which the steered ship's controls stay
  const auto world = simulation::make_world("flight", {simulation::shape_of(tree)}, 10, seed);
  simulation::Draw draw(seed + 1000);
  std::vector<Query> calls;
  for (int step = 0; calls.size() < count; ++step) {
    if (step % kControlSteps == 0) world->steering = {draw.uniform(0, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
    world->time = step * world->scene.step;
    world->scene.before(*world, world->time);
    for (std::uint32_t a = 0; a < world->bodies.size(); ++a) {
      for (std::uint32_t b = a + 1; b < world->bodies.size() && calls.size() < count; ++b) {
        const simulation::Body &one = world->bodies[a], &two = world->bodies[b];
        if (runtime::length(one.position - two.position) > one.radius + two.radius) continue;
        calls.push_back({pose_of(one, world->shapes[0]), pose_of(two, world->shapes[0]), 0});
      }
    }
    respond_and_move(*world, world->detection.step(world->time, {}));
  }
  return calls;
}

}  // namespace orchard::bench
