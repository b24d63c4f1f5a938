// A rocket between 500 asteroids, half of them at rest: asks at every frame which bounding spheres overlap, and prints
// how rarely anything has to be computed for it.
#include <cmath>
#include <cstdio>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/motion_helpers.h"

using namespace orchard::runtime;

int main() {
  // Kept by the application, by BodyIndex, as of the present frame: what is known of each body's motion.
  std::vector<Motion> motions;
  BroadPhase world(values_of(motions), {.time_step = 0.02});

  Rocket rocket;  // flies along x, its engine adds up to 4 units/s^2 forwards, its rudder turns it by up to 0.5 rad/s
  rocket.velocity = {6, 0, 0};
  rocket.radius = 1;
  rocket.max_thrust = 4;
  rocket.max_turning = 0.5;
  motions.push_back(rocket_motion(rocket, 0, 2));
  const BodyId ship = world.add();

  for (int i = 1; i <= 500; ++i) {
    Motion asteroid;  // drifts steadily: no acceleration, for ever
    asteroid.position = {std::fmod(i * 37.7, 200), std::fmod(i * 91.3, 60) - 30, std::fmod(i * 53.9, 60) - 30};
    asteroid.radius = 1 + i % 3;
    if (i % 2 == 0) asteroid.velocity = {std::sin(i), std::cos(i), std::sin(2.0 * i)};
    motions.push_back(asteroid);
    i % 2 == 0 ? world.add() : world.add_static(asteroid);
  }

  std::size_t hits = 0;
  const int frames = 500;
  const double dt = 0.02;
  for (int frame = 0; frame < frames; ++frame) {
    const double time = frame * dt;
    // The ship's bounds are given again whenever the broad phase asks: they start from its present place.
    motions[ship.index] = rocket_motion(rocket, time, 2);
    const Advance now = world.advance(time);
    for (const BodyPair& pair : now.pairs) {
      if (pair.a != ship.index) continue;
      if (hits++ == 0) std::printf("%.2f s: the ship's sphere meets asteroid %u's\n", now.time, pair.b);
    }
    for (Motion& motion : motions) motion.position = motion.position + dt * motion.velocity;
    const double thrust = frame % 100 < 50 ? 4 : 0;
    rocket.position = rocket.position + dt * rocket.velocity + (dt * dt / 2 * thrust) * rocket.axis;
    rocket.velocity = rocket.velocity + (dt * thrust) * rocket.axis;
  }
  std::printf("%zu overlaps of the ship in %d frames; %.2f motions asked for per body, not %d\n", hits, frames,
              static_cast<double>(world.motions_asked()) / static_cast<double>(world.size()), frames);
  return hits > 0 ? 0 : 1;
}
