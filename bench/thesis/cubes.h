#pragma once
#include <functional>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "spatial_hash.h"

namespace orchard::bench {

inline constexpr double kFrame = 0.02, kDetection = kFrame / 2, kEnd = 3, kPeriod = 0.5;  // seconds

// Section 7.1: isothetic cubes under forces. Their positions come from a differential equation solver, at times that
// never decrease.
class Cubes {
 public:
  Cubes(std::size_t count, double ball, std::uint64_t seed);

  std::vector<double> halves;   // of the edges
  std::vector<Vec3> positions;  // as of the last solve_all()
  double solver_seconds = 0;

  std::size_t size() const { return cubes_.size(); }
  void solve_all(double time);
  runtime::MotionSource source();
  bool collide(BodyIndex a, BodyIndex b, double time);

 private:
  struct Period {
    double bound;
    Vec3 half_space;
  };
  struct Cube {
    Vec3 position, velocity;
    double time, step;  // up to when it is solved; the solver's next step
    std::vector<Vec3> forces;
    std::vector<Period> periods;
  };
  const Cube& solved(std::size_t i, double time);

  std::vector<Cube> cubes_;
};

struct Run {
  double overall = 0, detection = 0, collision = kEnd;
  std::vector<double> frames;  // detection-only seconds of each
  std::uint64_t asked = 0;     // motions, by the broad phase
  std::size_t memory = 0;

  double worst() const { return frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()); }
};

using MakeBroadPhase = std::function<runtime::BroadPhase(runtime::MotionSource)>;

// Frames until `end`, or with `stop` until the first collision. `memory`: of the hash, at most; 0: as it likes.
Run run_bounds(std::size_t count, double ball, std::uint64_t seed, const MakeBroadPhase& make, double end = kEnd,
               bool stop = true);
Run run_hash(std::size_t count, double ball, std::uint64_t seed, std::size_t memory, double cell, double end = kEnd,
             bool stop = true);

}  // namespace orchard::bench
