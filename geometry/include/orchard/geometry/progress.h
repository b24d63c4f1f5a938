#pragma once
#include <functional>
#include <string_view>

#include "orchard/geometry/error.h"

// The callback by which long stages report their progress.
namespace orchard {

// A callback that receives the name of a stage and the fraction done, in [0, 1], on the thread that runs the stage. If
// it returns false, the stage throws Cancelled. An empty function reports nothing.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

// Calls the callback unless it is empty. Throws Cancelled if it returns false.
inline void report_progress(const Progress& progress, std::string_view stage, double fraction) {
  if (progress && !progress(stage, fraction)) throw Cancelled();
}

}  // namespace orchard
