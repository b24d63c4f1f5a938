#include "robot/urdf_values.h"

#include <fmt/format.h>

#include <cmath>

#include "input/xml_file.h"
#include "orchard/geometry/error.h"

namespace orchard::robot {

namespace fs = std::filesystem;
using apps::at_line;
using tinyxml2::XMLElement;

std::string required(const XMLElement& element, const char* name, const fs::path& file) {
  const char* value = element.Attribute(name);
  if (value == nullptr || *value == '\0')
    throw InputError(fmt::format("{}: <{}> has no {}", at_line(file, element), element.Name(), name));
  return value;
}

double number(const XMLElement& element, const char* name, double standard, const fs::path& file) {
  const char* text = element.Attribute(name);
  if (text == nullptr) return standard;
  const double value = apps::numbers_in(text, 1, at_line(file, element), name).front();
  if (!std::isfinite(value)) throw InputError(fmt::format("{}: {} is not finite", at_line(file, element), name));
  return value;
}

double positive(const XMLElement& element, const char* name, const fs::path& file) {
  required(element, name, file);
  const double value = number(element, name, 0, file);
  if (!(value > 0)) throw InputError(fmt::format("{}: {} must be above 0", at_line(file, element), name));
  return value;
}

Vector vector(const XMLElement& element, const char* name, const Vector& standard, const fs::path& file) {
  const char* text = element.Attribute(name);
  if (text == nullptr) return standard;
  const std::vector<double> values = apps::numbers_in(text, 3, at_line(file, element), name);
  Vector value(values[0], values[1], values[2]);
  if (!value.allFinite()) throw InputError(fmt::format("{}: {} is not finite", at_line(file, element), name));
  return value;
}

Vector positive_vector(const XMLElement& element, const char* name, const fs::path& file) {
  required(element, name, file);
  Vector value = vector(element, name, Vector::Zero(), file);
  if (!(value.array() > 0).all())
    throw InputError(fmt::format("{}: {} must be three numbers above 0", at_line(file, element), name));
  return value;
}

Motion motion_of(const Vector& xyz, const Vector& rpy) {
  Motion motion = Motion::Identity();
  motion.linear() = (Eigen::AngleAxisd(rpy.z(), Vector::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector::UnitY()) *
                     Eigen::AngleAxisd(rpy.x(), Vector::UnitX()))
                        .toRotationMatrix();
  motion.translation() = xyz;
  return motion;
}

Motion read_origin(const XMLElement& parent, const fs::path& file) {
  const XMLElement* origin = parent.FirstChildElement("origin");
  if (origin == nullptr) return Motion::Identity();
  return motion_of(vector(*origin, "xyz", Vector::Zero(), file), vector(*origin, "rpy", Vector::Zero(), file));
}

Inertial read_inertial(const XMLElement& element, const fs::path& file) {
  Inertial inertial;
  const XMLElement* mass = element.FirstChildElement("mass");
  if (mass == nullptr) throw InputError(at_line(file, element) + ": <inertial> has no <mass>");
  required(*mass, "value", file);
  inertial.mass = number(*mass, "value", 0, file);
  if (inertial.mass < 0) throw InputError(at_line(file, *mass) + ": the mass is below 0");
  const Motion origin = read_origin(element, file);
  inertial.center = origin.translation();
  const XMLElement* inertia = element.FirstChildElement("inertia");
  if (inertia == nullptr) return inertial;
  const auto part = [&](const char* name) { return number(*inertia, name, 0, file); };
  Eigen::Matrix3d own;
  own << part("ixx"), part("ixy"), part("ixz"), part("ixy"), part("iyy"), part("iyz"), part("ixz"), part("iyz"),
      part("izz");
  inertial.inertia = origin.linear() * own * origin.linear().transpose();
  return inertial;
}

}  // namespace orchard::robot
