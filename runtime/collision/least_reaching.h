#pragma once
#include <span>

#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// Half-spaces that the way out has to reach: normal . x >= height.
struct Obstacle {
  Vec3 normal;
  double height;
};

inline constexpr double kReaches = 1e-12;  // of the bodies' size: what counts as reaching a plane

// The least vector that reaches all of them, or zero if there is none.
Vec3 min_reaching(std::span<const Obstacle> obstacles, double size) noexcept;

}  // namespace orchard::runtime::detail
