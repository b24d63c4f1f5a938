#pragma once
#include <cstdint>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "worlds.h"

namespace orchard::bench {

using runtime::BodyIndex;
using runtime::BodyPair;
using runtime::Motion;
using runtime::Vec3;
using runtime::operator+;
using runtime::operator-;
using runtime::operator*;

// Spheres of radius 0.5 to 1.5 in a ball, 100 in radius 200 at density 1 (dissertation 4.2.5), speeds 5 to 15 at speed
// 1, accelerations below M, which is uniform in [0, 4] at acceleration 1 for each body; M and the acceleration are
// drawn again every second.
struct SceneShape {
  std::size_t bodies = 1000;
  double density = 1, speed = 1, acceleration = 1;
  bool staggered = false;  // a hundredth of the bodies draws again at each step, not all at the end of each second
  double time_step = 0.01;
};

// The application: positions are those of the present step, as it would have them for drawing.
class Scene {
 public:
  Scene(const SceneShape& shape, std::uint64_t seed);

  void next_step();
  const SceneShape& shape() const { return shape_; }
  double time() const { return step_ * shape_.time_step; }
  std::size_t size() const { return positions_.size(); }
  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<double>& radii() const { return radii_; }
  runtime::MotionSource source() const;

 private:
  void redraw(std::size_t body);

  SceneShape shape_;
  runtime::test::Draw draw_;
  int step_ = 0, steps_per_second_;
  std::vector<Vec3> positions_;
  std::vector<double> radii_;
  struct Drive {
    Vec3 velocity, acceleration;
    double bound, expiry;
  };
  std::vector<Drive> drives_;
};

// Something that finds the overlapping pairs of a step, given positions.
class Rival {
 public:
  virtual ~Rival() = default;
  virtual void find(std::vector<BodyPair>& pairs) = 0;
  virtual std::size_t memory_bytes() const { return 0; }
};

}  // namespace orchard::bench
