#include "worlds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orchard::runtime::test {

Vec3 Draw::direction() {
  const double z = uniform(-1, 1), angle = uniform(0, 2 * std::numbers::pi), across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

Vec3 Draw::in_ball(double radius) { return radius * std::cbrt(uniform(0, 1)) * direction(); }

MovingBodies::MovingBodies(const WorldShape& shape, std::uint64_t seed) {
  Draw draw(seed);
  for (std::size_t i = 0; i < shape.bodies; ++i) {
    Body body{draw.uniform(shape.min_radius, shape.max_radius), {}, {}};
    Vec3 position = draw.in_ball(shape.ball);
    Vec3 velocity = draw.uniform(shape.min_speed, shape.max_speed) * draw.direction() + shape.wind;
    const bool cut = draw.uniform(0, 1) < shape.half_spaces;
    double begin = shape.staggered ? -draw.uniform(0, shape.period) : 0;
    while (begin <= shape.end) {
      Period period{begin, begin + shape.period, draw.uniform(0, shape.max_acceleration), {}};
      if (cut) period.half_space = draw.uniform(0.1, 3) * draw.direction();
      const double step = shape.period / shape.forces_per_period;
      for (int f = 0; f < shape.forces_per_period; ++f) {
        Vec3 acceleration = (shape.extreme ? period.bound : draw.uniform(0, period.bound)) * draw.direction();
        if (dot(acceleration, period.half_space) > 0) acceleration = -1.0 * acceleration;
        body.forces.push_back({begin + f * step, position, velocity, acceleration});
        position = position + step * velocity + (step * step / 2) * acceleration;
        velocity = velocity + step * acceleration;
      }
      body.periods.push_back(period);
      begin += shape.period;
    }
    bodies_.push_back(std::move(body));
  }
}

Motion MovingBodies::motion(BodyIndex id, double time) const {
  const Body& body = bodies_[id];
  const auto after = [&](const auto& part) { return time < part.begin; };
  const auto force = std::find_if(body.forces.begin() + 1, body.forces.end(), after) - 1;
  const auto period = std::find_if(body.periods.begin() + 1, body.periods.end(), after) - 1;
  const double t = time - force->begin;
  Motion motion;
  motion.position = force->position + t * force->velocity + (t * t / 2) * force->acceleration;
  motion.velocity = force->velocity + t * force->acceleration;
  motion.radius = body.radius;
  motion.acceleration = period->bound;
  motion.half_space = period->half_space;
  motion.expiry = period->end;
  return motion;
}

MotionSource MovingBodies::source() const {
  return [this](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    for (std::size_t i = 0; i < bodies.size(); ++i) motions[i] = motion(bodies[i], time);
  };
}

std::vector<BodyPair> MovingBodies::touching(double time) const {
  std::vector<Motion> motions;
  for (BodyIndex i = 0; i < size(); ++i) motions.push_back(motion(i, time));
  std::vector<BodyPair> pairs;
  for (BodyIndex i = 0; i < size(); ++i) {
    for (BodyIndex j = i + 1; j < size(); ++j) {
      if (spheres_touch(motions[i], motions[j])) pairs.push_back({i, j});
    }
  }
  return pairs;
}

}  // namespace orchard::runtime::test
