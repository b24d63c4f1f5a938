#pragma once
#include <functional>
#include <string_view>

#include "orchard/geometry/error.h"

namespace orchard {

// Called from the thread that runs a stage, with the stage's name and the fraction done in [0, 1]. Returning false
// makes the stage throw Cancelled. An empty function reports nothing.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

inline void report_progress(const Progress& progress, std::string_view stage, double fraction) {
  if (progress && !progress(stage, fraction)) throw Cancelled();
}

}  // namespace orchard
