#pragma once
#include <cstdint>

#include "level_objective.h"

namespace orchard::detail {

struct LevelOptions {
  Index balls = 8;          // at most
  Index max_children = 16;  // balls in a path region at most
  LevelCost cost;
  BallMeasure measure = BallMeasure::reach;
  bool keep_above = false;  // whether the levels above are not to grow
  std::uint64_t seed = 1;
  Index level = 1;  // for the random numbers
};

}  // namespace orchard::detail
