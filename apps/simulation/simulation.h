#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene.h"

namespace orchard::simulation {

inline constexpr std::size_t kLevels = 12;  // counted one by one; deeper ones with the last, the triangles in front

// A frame as it was counted, the same on every machine, and as it was timed.
struct FrameRecord {
  std::size_t frame = 0;
  double time = 0;
  std::size_t bodies = 0, pairs = 0, no = 0, maybe = 0, yes = 0;
  std::array<std::size_t, kLevels> stopped{};  // "maybe", by the level where the budget ended
  double worst_bound = 0;                      // of what is not certain, finite or the bodies' size
  std::uint64_t work = 0, motions = 0, left_over = 0;
  std::uint64_t state = 0;  // a checksum of all bodies

  double seconds_detection = 0, seconds_other = 0;
};

// What ended a step: its budget in work, and where one in time cut it short.
struct StepLimit {
  std::uint64_t work = runtime::Budget{}.work;
  runtime::StepCut cut;
};

enum class Limits { none, work, time };

// What came from outside, one entry a frame and one a step: enough to run it again, step for step.
struct Recording {
  std::string scene, shape;  // the shape: a checksum of its tree
  std::size_t bodies = 0;
  std::uint64_t seed = 0;
  Limits limits = Limits::none;
  std::vector<Steering> steering;
  std::vector<StepLimit> steps;
};
std::string to_text(const Recording& recording);
// Throws std::runtime_error with the line that is wrong.
Recording parse_recording(const std::string& text);
std::string checksum(const runtime::TreeView& tree);

class Simulation {
 public:
  // `replay` gives steering and the limits of each step in place of the budget; it outlives this. Frames beyond its end
  // throw std::out_of_range.
  Simulation(const std::string& scene, const std::vector<Shape>& shapes, std::size_t bodies, std::uint64_t seed,
             const Recording* replay = nullptr);

  // One frame: as many steps as it has, each within its share of the budget.
  FrameRecord frame(const runtime::Budget& budget, const Steering& steering = {});

  const World& world() const { return *world_; }
  World& world() { return *world_; }
  const std::vector<PairOutcome>& pairs() const { return last_.pairs; }  // of the last step, but for those apart
  const Recording& recording() const { return recording_; }
  int steps_per_frame() const { return steps_; }

 private:
  runtime::Budget budget_of_step(const runtime::Budget& frame) const;

  std::unique_ptr<World> world_;
  const Recording* replay_;
  Recording recording_;
  StepOutcome last_;
  int steps_;
  std::size_t frames_ = 0, steps_done_ = 0;
};

// The columns of a trace, counted ones alone or timed ones alone.
std::string trace_header();
std::string trace_row(const FrameRecord& record);
std::string times_header();
std::string times_row(const FrameRecord& record);

}  // namespace orchard::simulation
