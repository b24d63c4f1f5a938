#pragma once
#include <set>
#include <utility>

#include "scenes.h"

// Who touches at a step, by comparing everything with everything; and how far apart what does not touch is.
namespace orchard::runtime::test {

// Bodies by their place in the scene; half-space i is bodies.size() + i.
using Touching = std::set<std::pair<std::size_t, std::size_t>>;

struct StepTruth {
  Touching touching;
  Touching close;  // within rounding of a contact, of simple shapes: either answer will do
};

class SceneOracle {
 public:
  explicit SceneOracle(const Scene& scene) : scene_(&scene) {}
  StepTruth at(int step) const;

 private:
  const Scene* scene_;
};

}  // namespace orchard::runtime::test
