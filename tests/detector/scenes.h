#pragma once
#include <limits>
#include <string>
#include <vector>

#include "orchard/runtime/detector.h"
#include "support.h"

// Recorded motions of many bodies, for the detector's tests and benchmarks. They come from a penalty solver, in which
// bodies are balls that push each other apart: what is recorded are poses, and nothing here asks orchard who touches.
namespace orchard::runtime::test {

struct SceneShape {
  enum class Kind { tree, round, box } kind = Kind::tree;
  PackedSphereTree tree;  // of boxes, too: for the oracle
  Vec3 p{}, q{};          // of a box: half of its lengths in p
  double radius = 0;
};

struct SceneBody {
  std::vector<std::size_t> parts;  // shapes
  bool is_static = false;
  int birth = 0, death = std::numeric_limits<int>::max();  // steps: there from birth to death - 1
  BodyOptions options{};
};

struct ScenePlane {
  Vec3 normal{};
  double offset = 0;
};

struct Scene {
  std::string name;
  double dt = 0.01;
  int steps = 0;
  std::vector<SceneShape> shapes;
  std::vector<SceneBody> bodies;
  std::vector<ScenePlane> planes;
  std::vector<std::vector<Pose>> poses;                // [step][body]
  std::vector<std::vector<std::vector<Pose>>> locals;  // [step][body][part], of articulated bodies; else empty

  // Parts of the body that move in its frame.
  std::size_t joints(std::size_t body) const { return locals.empty() ? 0 : locals[0][body].size(); }
  Pose local(int step, std::size_t body, std::size_t part) const {
    return locals.empty() || locals[static_cast<std::size_t>(step)][body].empty()
               ? Pose{}
               : locals[static_cast<std::size_t>(step)][body][part];
  }
  // What can be promised at the step, knowing the rest of the recording: kept for `horizon` steps. Played backwards,
  // the recorded step is at `time`, and those before it come next.
  BodyState state(int step, std::size_t body, int horizon) const;
  BodyState state_backwards(int step, double time, std::size_t body, int horizon) const;

 private:
  BodyState bounded(int step, int way, int end, std::size_t body, int horizon) const;
};

// Each with about that many bodies, all deterministic.
Scene flight(std::size_t bodies, int steps, std::uint64_t seed);
Scene falling_pile(std::size_t bodies, int steps, std::uint64_t seed);
Scene asteroid_field(std::size_t bodies, int steps, std::uint64_t seed);
Scene robot_arm(std::size_t obstacles, int steps, std::uint64_t seed);
Scene machines(std::size_t bodies, int steps, std::uint64_t seed);
Scene bouncing_box(std::size_t bodies, int steps, std::uint64_t seed);
Scene conveyor(std::size_t bodies, int steps, std::uint64_t seed);
Scene clusters(std::size_t bodies, int steps, std::uint64_t seed);
// Of rings of 2,048 triangles each, and so none of every_scene(): brute force takes too long.
Scene chain(std::size_t bodies, int steps, std::uint64_t seed);
std::vector<Scene> every_scene(std::size_t bodies, int steps, std::uint64_t seed);

}  // namespace orchard::runtime::test
