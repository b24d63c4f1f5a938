#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "worlds.h"

// The scenes of the table in docs/results/benchmarks.md, for the benchmark and for a test that compares them with brute
// force.
namespace orchard::runtime::test {

enum class SceneKind : std::uint8_t {
  uniform,         // a ball of bodies, 100 in radius 200 (dissertation 4.2.5); bounds drawn again every second
  staggered,       // the same, a hundredth of the bounds at each step
  slab,            // a floor: 20 x 20 for each body, 4 high
  corridor,        // 20 long for each body, 8 x 8 across
  explosion,       // packed in a ball, then flying apart at up to 50
  bouncing,        // falling on a floor, where the velocity jumps
  pile_asleep,     // a cubic lattice in which each body overlaps its neighbours, at rest
  pile_jitter,     // each body swings about its place, within its bound
  pile_cancelled,  // the same, and no bound holds for longer than a step
  teleporting,     // a share of the bodies is somewhere else at each step; ten times as dense
  replaced,        // a share of the bodies is removed at each step, and others added; ten times as dense
  coincident,      // all at one place, at rest
  clusters,        // 80 % in 1 % of the volume
  pareto,          // radii from 0.5 to 50, few large
  stream,          // all at about 100 in the same direction
  orbit,           // a disc of circular orbits around a centre
};

struct SceneSpec {
  const char* name;
  SceneKind kind;
  std::size_t bodies;
  double share = 0;  // of the bodies that change at each step
  int steps = 300;
};

// The table's rows, those with rich contacts first, up to so many bodies.
std::vector<SceneSpec> table_scenes(std::size_t max_bodies);

// The application: it knows where its bodies are at the present step, and promises what it knows of their motion.
// Promises are kept up to rounding: an acceleration is constant for a step, or the path is given in closed form.
class TableScene {
 public:
  static constexpr double kStep = 0.01;

  TableScene(const SceneSpec& spec, std::uint64_t seed);

  void next_step();
  double time() const { return step_ * kStep; }
  std::size_t size() const { return positions_.size(); }
  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<double>& radii() const { return radii_; }
  Motion motion(BodyIndex body) const;
  MotionSource source() const;  // of the present step; the scene outlives it
  // What the last next_step() did: bodies whose promise is void, and bodies with another one at their index.
  const std::vector<BodyIndex>& broken() const { return broken_; }
  const std::vector<BodyIndex>& replaced() const { return replaced_; }

 private:
  struct Drive {
    Vec3 velocity, acceleration;
    double bound = 0, expiry = std::numeric_limits<double>::infinity();
    Vec3 half_space{};
  };
  struct Swing {  // about `home`, or around the origin: a turn of `rate` per second from `phase` on, from x to y
    Vec3 home, x, y;
    double rate, phase;
  };

  void place(std::size_t body);
  void place_in_pile(std::size_t body);
  void place_in_orbit(std::size_t body);
  void redraw(std::size_t body);
  void move(std::size_t body);
  void swing(std::size_t body);
  void fall(std::size_t body);
  void change_some();
  bool redraws() const;
  Vec3 in_cluster();

  SceneSpec spec_;
  Draw draw_;
  int step_ = 0;
  double ball_ = 0;
  std::vector<Vec3> positions_;
  std::vector<double> radii_;
  std::vector<Drive> drives_;
  std::vector<Swing> swings_;   // empty but for the piles and orbits
  std::vector<Vec3> clusters_;  // centres
  std::vector<BodyIndex> broken_, replaced_;
};

// A broad phase that lives through a scene.
class SceneWorld {
 public:
  SceneWorld(const TableScene& scene, BroadPhase world);  // the world is empty

  // Tells what the scene's last step has changed, and advances to its time. Once for each of its steps.
  Advance step(const TableScene& scene);
  const BroadPhase& world() const { return world_; }

 private:
  BroadPhase world_;
  std::vector<BodyId> ids_;  // by index
};

}  // namespace orchard::runtime::test
