#pragma once
#include <limits>

namespace orchard::detail {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace orchard::detail
