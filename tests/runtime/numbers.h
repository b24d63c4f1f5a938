#pragma once
#include <limits>

// Numbers that the tests of the run-time share.
namespace orchard::runtime::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline constexpr double kStep = 0.01;  // the time step of broad phases and detectors
inline double time_at(int step) { return step * kStep; }

}  // namespace orchard::runtime::test
