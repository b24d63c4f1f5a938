#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "robot/link_shape.h"

// How commands read a robot.
namespace orchard::apps {

struct RobotReading {
  std::vector<std::filesystem::path> packages;  // of package://
  bool visual = false;                          // visual geometry in place of collision geometry
  robot::DaeOptions dae;
};

inline robot::UrdfOptions urdf_options(const RobotReading& reading) {
  return {.packages = reading.packages,
          .geometry = reading.visual ? robot::Geometry::visual : robot::Geometry::collision};
}

inline robot::ShapeOptions shape_options(const RobotReading& reading, bool wrap, std::optional<double> join = {}) {
  return {.geometry = reading.visual ? robot::Geometry::visual : robot::Geometry::collision,
          .dae = reading.dae,
          .wrap = wrap,
          .join = join};
}

}  // namespace orchard::apps
