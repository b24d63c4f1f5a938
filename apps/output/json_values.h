#pragma once
#include <nlohmann/json.hpp>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/mesh.h"

// How reports have points and proven bounds.
namespace orchard::apps {

inline nlohmann::json point_json(const Point& point) { return {point.x(), point.y(), point.z()}; }
// [lower, upper] in another unit.
inline nlohmann::json bounds_json(const Bounds& bounds, double unit = 1) {
  return {bounds.lower / unit, bounds.upper / unit};
}

}  // namespace orchard::apps
