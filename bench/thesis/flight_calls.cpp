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
    const simulation::StepOutcome outcome = world->detection.step(world->time, {});
    for (const simulation::PairOutcome& pair : outcome.pairs) {
      if (calls.size() == count) break;
      const auto pose = [&](std::uint32_t body) { return pose_of(world->bodies[body], world->shapes[0]); };
      calls.push_back({pose(pair.a), pose(pair.b), 0});
    }
    respond_and_move(*world, outcome);
  }
  return calls;
}

}  // namespace orchard::bench
