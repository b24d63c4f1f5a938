#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "body.h"
#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/narrow_phase.h"

namespace orchard::simulation {

// A shape that bodies have: its tree, and the middle of its bounding sphere, which is what moves.
struct Shape {
  runtime::TreeView tree;
  Vec3 center{};
  double radius = 1;
};
Shape shape_of(const runtime::TreeView& tree);
Pose pose_of(const Body& body, const Shape& shape);

bool unlimited(const runtime::Budget& budget);  // neither in work nor in time

// What is known of a pair of bodies when a step's budget is used up.
struct PairOutcome {
  std::uint32_t a = 0, b = 0;  // a < b
  runtime::Verdict verdict;
  bool exact = false;  // the triangles were reached
};

struct StepOutcome {
  std::vector<PairOutcome> pairs;  // whose bounding spheres overlap, ascending
  std::uint64_t work = 0;          // of the narrow phase, in the units of runtime::Budget; starting pairs included
  std::uint64_t refined = 0;       // of it, what the budget was spent on
  std::uint64_t motions = 0;       // that the broad phase asked for
  double seconds_broad = 0, seconds_narrow = 0;
};

// The seam between the simulator and whatever detects: both phases, one budget a step, a level each in turn (7.3);
// without a budget each pair goes straight to its triangles.
// Bodies are named by their index in the simulator's array.
class Detection {
 public:
  Detection(const std::vector<Body>& bodies, const std::vector<Shape>& shapes, double time_step);

  void add(std::uint32_t body);
  void remove(std::uint32_t body);
  void cancel(std::uint32_t body);  // what was promised for it holds no longer

  StepOutcome step(double time, const runtime::Budget& budget);

  // The promise that the broad phase has of a body, and since when; for looking at.
  struct Promise {
    Motion motion;
    double since = 0;
  };
  std::span<const Promise> promises() const { return promises_; }

 private:
  using Kind = std::pair<std::uint32_t, std::uint32_t>;
  struct Pool {
    std::vector<std::unique_ptr<runtime::NarrowPhase>> pairs;
    std::size_t used = 0;
  };
  runtime::NarrowPhase& narrow(std::uint32_t shape_a, std::uint32_t shape_b);
  void refine(std::vector<runtime::NarrowPhase*>& pairs, const runtime::Budget& budget, StepOutcome& outcome);

  const std::vector<Body>& bodies_;
  const std::vector<Shape>& shapes_;
  runtime::BroadPhase broad_;
  std::vector<runtime::BodyId> ids_;    // by body; those of static ones too
  std::vector<std::uint32_t> body_of_;  // by the broad phase's index
  std::vector<Promise> promises_;       // by body
  std::map<Kind, Pool> pools_;
};

}  // namespace orchard::simulation
