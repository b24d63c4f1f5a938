#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "moving_octree.h"
#include "orchard/runtime/broad_phase.h"
#include "spatial_hash.h"

namespace orchard::bench {

inline constexpr double kFrame = 0.02, kDetection = kFrame / 2, kEnd = 3, kPeriod = 0.5;  // seconds

// How a cube's M and d in one period follow from those in the period before, "an interesting topic" of 7.1.
enum class Relation {
  none,         // both are drawn again each time, as published
  steady,       // both stay
  turning,      // d turns by 30 degrees at most, M changes by a tenth at most
  alternating,  // d is reversed, M stays
  shared        // drawn again each time, but alike for all cubes: wind
};

struct CubeScene {
  std::size_t count;
  double ball;  // initial positions lie in a ball of this radius
  std::uint64_t seed;
  Relation relation = Relation::none;
};

// Section 7.1: isothetic cubes under forces. Their positions come from a differential equation solver, at times that
// never decrease.
class Cubes {
 public:
  explicit Cubes(const CubeScene& scene);

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
  static Period period_after(const Period& last, Relation relation, runtime::test::Draw& draw);
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

using MakeRival = std::function<std::unique_ptr<Rival>(const Cubes&)>;

// Turk's hash with at most `memory` bytes (0: as it likes) and cells of the edge `cell`; and octrees.
MakeRival hash_of(std::size_t memory, double cell);
// The fastest edge of a cell where the cubes begin.
double best_cell(const CubeScene& scene);
MakeRival octree_of(MovingOctree::Upkeep upkeep);

// Frames until `end`, or with `stop` until the first collision. A rival is asked at each detection step.
Run run_bounds(const CubeScene& scene, const MakeBroadPhase& make, double end = kEnd, bool stop = true);
Run run_rival(const CubeScene& scene, const MakeRival& make, double end = kEnd, bool stop = true);

}  // namespace orchard::bench
