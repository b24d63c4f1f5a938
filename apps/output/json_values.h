#pragma once
#include <cctype>
#include <nlohmann/json.hpp>
#include <string>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/stage_times.h"

// How reports write points, proven bounds and times.
namespace orchard::apps {

inline nlohmann::json point_json(const Point& point) { return {point.x(), point.y(), point.z()}; }
// [lower, upper] in another unit.
inline nlohmann::json bounds_json(const Bounds& bounds, double unit = 1) {
  return {bounds.lower / unit, bounds.upper / unit};
}

// Seconds by stage, with keys in lower_snake: "gap_repair" for "gap repair".
inline nlohmann::json seconds_json(const StageTimes& times) {
  nlohmann::json seconds = nlohmann::json::object();
  for (const auto& [stage, time] : times) {
    std::string key = stage;
    for (char& c : key) c = c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    seconds[key] = time;
  }
  return seconds;
}

}  // namespace orchard::apps
