#include "scene.h"

#include <cmath>

namespace orchard::bench {

Scene::Scene(const SceneShape& shape, std::uint64_t seed)
    : shape_(shape), draw_(seed), steps_per_second_(static_cast<int>(std::lround(1 / shape.time_step))) {
  const double ball = 200 * std::cbrt(static_cast<double>(shape.bodies) / (100 * shape.density));
  for (std::size_t i = 0; i < shape.bodies; ++i) {
    positions_.push_back(draw_.in_ball(ball));
    radii_.push_back(draw_.uniform(0.5, 1.5));
    drives_.push_back({shape.speed * draw_.uniform(5, 15) * draw_.direction(), {}, 0, 0});
    redraw(i);
    if (shape.staggered)
      drives_[i].expiry = static_cast<double>(1 + i % static_cast<std::size_t>(steps_per_second_)) * shape.time_step;
  }
}

void Scene::redraw(std::size_t i) {
  Drive& drive = drives_[i];
  drive.bound = 4 * shape_.acceleration * draw_.uniform(0, 1);
  drive.acceleration = draw_.uniform(0, drive.bound) * draw_.direction();
  drive.expiry = time() + 1;
}

void Scene::next_step() {
  const double dt = shape_.time_step;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const Drive& drive = drives_[i];
    positions_[i] = positions_[i] + dt * drive.velocity + (dt * dt / 2) * drive.acceleration;
    drives_[i].velocity = drive.velocity + dt * drive.acceleration;
  }
  ++step_;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    if (drives_[i].expiry < time() + dt / 2) redraw(i);
  }
}

runtime::MotionSource Scene::source() const {
  return [this](double, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const BodyIndex i = bodies[k];
      const Drive& drive = drives_[i];
      Motion& motion = motions[k];
      motion.position = positions_[i];
      motion.velocity = drive.velocity;
      motion.radius = radii_[i];
      motion.acceleration = drive.bound;
      motion.drift = 0;
      motion.half_space = {};
      motion.expiry = drive.expiry;
    }
  };
}

}  // namespace orchard::bench
