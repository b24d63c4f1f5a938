#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "body.h"
#include "orchard/runtime/detector.h"

namespace orchard::simulation {

// A shape that bodies have: its tree, and the middle of its bounding sphere, which is what moves.
struct Shape {
  runtime::TreeView tree;
  Vec3 center{};
  double radius = 1;
};
Shape shape_of(const runtime::TreeView& tree);
Pose pose_of(const Body& body, const Shape& shape);

// What is known of a pair of bodies when a step's budget is used up.
struct PairOutcome {
  std::uint32_t a = 0, b = 0;  // a < b
  runtime::Verdict verdict;
};

struct StepOutcome {
  std::vector<PairOutcome> pairs;  // that touch or may touch, ascending
  std::uint64_t overlapping = 0;   // pairs whose bounding spheres overlap
  std::uint64_t work = 0;          // in the units of runtime::Budget
  std::uint64_t motions = 0;       // that the broad phase asked for
  std::uint64_t left_over = 0;     // bodies and pairs that its budget did not get to: pairs of them may be missing
  runtime::StepCut cut;            // where a budget in time ended
  double seconds = 0;
};

// The seam between the simulator and the run-time's detector: bodies are named by their index in the simulator's array.
class Detection {
 public:
  Detection(const std::vector<Body>& bodies, const std::vector<Shape>& shapes, double time_step);
  Detection(const Detection&) = delete;
  Detection& operator=(const Detection&) = delete;

  void add(std::uint32_t body);
  void remove(std::uint32_t body);
  void cancel(std::uint32_t body);    // what was promised for it holds no longer
  void teleport(std::uint32_t body);  // it is elsewhere: nor does what was known of its pairs

  // `replay`, unless null, says where the step ends, in place of the budget's time.
  StepOutcome step(double time, const runtime::Budget& budget, const runtime::StepCut* replay = nullptr);

  // The promise that the broad phase has of a body, and since when; for looking at.
  struct Promise {
    Motion motion;
    double since = 0;
  };
  std::span<const Promise> promises() const { return promises_; }

 private:
  runtime::DetectorOptions options(double time_step);
  runtime::BodyState state_of(std::uint32_t body) const;

  const std::vector<Body>& bodies_;
  const std::vector<Shape>& shapes_;
  std::vector<runtime::ShapeId> shape_ids_;
  std::vector<runtime::BodyId> ids_;    // by body; those of static ones too
  std::vector<std::uint32_t> body_of_;  // by the detector's index
  std::vector<Promise> promises_;       // by body
  runtime::Detector detector_;
};

}  // namespace orchard::simulation
