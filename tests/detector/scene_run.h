#pragma once
#include <map>
#include <memory>
#include <optional>

#include "scenes.h"

namespace orchard::runtime::test {

enum class Promises {
  known,     // from the rest of the recording, for some steps
  watched,   // the same, and checked
  suggested  // none: the detector watches and makes its own
};

// A detector that is taken through a scene.
class SceneRun {
 public:
  SceneRun(const Scene& scene, DetectorOptions options, Promises promises = Promises::known, int horizon = 8);

  // Bodies come and go, joints move, then the step is answered. Steps may be any, in ascending order of `time_step`:
  // the recording is played forth and back.
  Frame step(int time_step, const Budget& budget = {}, const StepOptions& options = {});
  int recorded(int time_step) const;  // which recorded step that is

  // The scene's numbers of an event's bodies, the smaller one first; half-space i is bodies + i.
  std::pair<std::size_t, std::size_t> numbers(const PairEvent& event) const;
  Detector& detector() { return *detector_; }
  BodyId id(std::size_t body) const { return ids_[body]; }
  ShapeId shape(std::size_t shape) const { return shapes_[shape]; }

 private:
  void add(std::size_t body);
  std::size_t number(BodyId id) const;

  const Scene* scene_;
  Promises bounds_;
  int horizon_;
  int step_ = -1;
  std::unique_ptr<Detector> detector_;
  std::vector<ShapeId> shapes_;
  std::vector<BodyId> ids_;
  std::vector<std::size_t> bodies_;  // by BodyIndex
  std::map<std::uint64_t, std::size_t> numbers_;
};

// All numbers of a frame's events, and of the frame: for comparing runs.
void append(std::vector<double>& all, const Frame& frame);

}  // namespace orchard::runtime::test
