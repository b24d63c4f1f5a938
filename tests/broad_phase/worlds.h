#pragma once
#include <cstdint>
#include <vector>

#include "../runtime/split_mix.h"
#include "orchard/runtime/broad_phase.h"

// Bodies that move within bounds they announce, for tests and benchmarks.
namespace orchard::runtime::test {

class Draw : public SplitMix {
 public:
  using SplitMix::SplitMix;
  Vec3 direction();
  Vec3 in_ball(double radius);
};

struct WorldShape {
  std::size_t bodies = 20;
  double ball = 10;  // initial positions lie in a ball of that radius
  double min_radius = 0.5, max_radius = 1.5;
  double min_speed = 5, max_speed = 15;
  double max_acceleration = 4;  // each body's M is uniform below, for a period
  double period = 1;            // M and the half-space change, all bodies' at the same times
  int forces_per_period = 5;    // changes of acceleration within the bounds
  double half_spaces = 0;       // the share of bodies that announce one
  bool extreme = false;         // accelerations of length M, not below
  bool staggered = false;       // the periods of different bodies start at different times
  double end = 1;               // motions are known up to here
  Vec3 wind{};                  // a velocity that all have besides
};

// Piecewise constant accelerations: positions are exact at any time, to rounding.
class MovingBodies {
 public:
  MovingBodies(const WorldShape& shape, std::uint64_t seed);

  std::size_t size() const { return bodies_.size(); }
  Motion motion(BodyIndex body, double time) const;
  MotionSource source() const;  // the object outlives it
  // The pairs that touch, by comparing all.
  std::vector<BodyPair> touching(double time) const;

 private:
  struct Force {  // from `begin` on
    double begin;
    Vec3 position, velocity, acceleration;
  };
  struct Period {
    double begin, end, bound;
    Vec3 half_space;
  };
  struct Body {
    double radius;
    std::vector<Force> forces;
    std::vector<Period> periods;
  };
  std::vector<Body> bodies_;
};

// Of a trial run: the pairs at any step that touch, and those of them that a broad phase did not find.
struct Misses {
  std::size_t touching = 0, missed = 0;
};

}  // namespace orchard::runtime::test
