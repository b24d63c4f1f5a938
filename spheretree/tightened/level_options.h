#pragma once
#include <cstdint>

#include "level_objective.h"

namespace orchard::detail {

struct LevelOptions {
  Index balls = 8;          // the maximum number of balls
  Index max_children = 16;  // the maximum number of balls in a path region
  LevelCost cost;
  BallMeasure measure = BallMeasure::reach;
  bool keep_above = false;  // whether the levels above must not grow
  std::uint64_t seed = 1;
  Index level = 1;  // selects the stream of random numbers
};

}  // namespace orchard::detail
