#pragma once
#include <tinyxml2.h>

#include <filesystem>
#include <string>

#include "robot/robot.h"

// Attributes and small elements of URDF. Everything throws InputError, with file and line, of what is not there or not
// what it is to be.
namespace orchard::robot {

std::string required(const tinyxml2::XMLElement& element, const char* name, const std::filesystem::path& file);
// A finite number; `standard` where the attribute is not there.
double number(const tinyxml2::XMLElement& element, const char* name, double standard,
              const std::filesystem::path& file);
double positive(const tinyxml2::XMLElement& element, const char* name, const std::filesystem::path& file);
Vector vector(const tinyxml2::XMLElement& element, const char* name, const Vector& standard,
              const std::filesystem::path& file);
Vector positive_vector(const tinyxml2::XMLElement& element, const char* name, const std::filesystem::path& file);

// x' = Rz(yaw) Ry(pitch) Rx(roll) x + xyz.
Motion motion_of(const Vector& xyz, const Vector& rpy);
// Of the child <origin>; the identity where there is none.
Motion read_origin(const tinyxml2::XMLElement& parent, const std::filesystem::path& file);
Inertial read_inertial(const tinyxml2::XMLElement& element, const std::filesystem::path& file);

}  // namespace orchard::robot
