#pragma once
#include <filesystem>
#include <vector>

#include "robot/robot.h"

namespace orchard::robot {

enum class Geometry : std::uint8_t { collision, visual };

struct UrdfOptions {
  std::vector<std::filesystem::path> packages{};  // folders of packages, or packages, for package://
  Geometry geometry = Geometry::collision;        // of which the meshes must be there
};

// Reads a URDF and looks for its meshes. What is unknown, unusual or left out is a line of Robot::notes each. Throws
// InputError, with file and line, for XML that is not well formed, numbers that are none, joints without their links,
// names that are there twice, loops of joints, xacro that is not expanded, and, in one message for all, meshes that are
// not there, with what was tried.
Robot read_urdf(const std::filesystem::path& file, const UrdfOptions& options = {});

// The elements that count. The other kind is not taken in their place.
const std::vector<Element>& elements_of(const Link& link, Geometry geometry);

}  // namespace orchard::robot
