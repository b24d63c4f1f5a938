// Two bodies fly through each other: each method reports them at the same steps as the run-time's own.
#include <cstdio>
#include <vector>

#include "orchard/broad_phase_methods/sleeping_broad_phase.h"
#include "orchard/broad_phase_methods/space_time_bound.h"

using namespace orchard::broad_phase_methods;
using namespace orchard::runtime;

namespace {

Motion at(double time, double side) {
  Motion motion;
  motion.position = {side * (1 - time), 0, 0};
  motion.velocity = {-side, 0, 0};
  motion.radius = 0.25;
  return motion;
}

std::vector<double> times_of_overlap(BroadPhase world) {
  world.add(), world.add();
  std::vector<double> times;
  for (int frame = 0; frame <= 200; ++frame) {
    for (Advance now = world.advance(0.01 * frame); !now.pairs.empty(); now = world.advance(0.01 * frame)) {
      times.push_back(now.time);
    }
  }
  return times;
}

}  // namespace

int main() {
  const MotionSource source = [](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    for (std::size_t i = 0; i < bodies.size(); ++i) motions[i] = at(time, bodies[i] == 0 ? 1 : -1);
  };
  const std::vector<double> expected = times_of_overlap(BroadPhase(source));
  bool right = expected.size() >= 50 && expected.size() <= 51;  // from 0.75 to 1.25 s
  for (const SleepingMethod method :
       {SleepingMethod::all_pairs, SleepingMethod::projection, SleepingMethod::subdivision, SleepingMethod::hybrid,
        SleepingMethod::quadratic, SleepingMethod::horns}) {
    right = right && times_of_overlap(make_sleeping_broad_phase(source, {.method = method})) == expected;
  }
  const double contact = first_contact(make_bound(at(0, 1), 0, 2), make_bound(at(0, -1), 0, 2), 2, BoundShape::horn);
  right = right && contact > 0.7499 && contact <= 0.75;
  std::printf("%zu overlaps, contact at %g: %s\n", expected.size(), contact, right ? "right" : "wrong");
  return right ? 0 : 1;
}
