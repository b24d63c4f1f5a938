#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh.h"

// A robot as URDF describes it: plain values, in metres and radians. This folder's library knows nothing of commands
// and options, so that programs and bindings can call it.
namespace orchard::robot {

using Motion = Eigen::Isometry3d;  // a rigid motion: x' = R x + t

enum class Shape : std::uint8_t { mesh, box, cylinder, sphere, capsule };

// One piece of a link's geometry: a shape around its own origin, scaled, then moved into the link's frame.
struct Element {
  Shape shape = Shape::mesh;
  std::string written = {};            // of a mesh: its name as the URDF has it
  std::filesystem::path file = {};     // of a mesh: where it was found
  Vector scale = Vector::Ones();       // of a mesh, before the origin; negative where it is mirrored
  Vector size = Vector::Zero();        // box: its sides; otherwise radius and length along z (capsule: without caps)
  Motion origin = Motion::Identity();  // from the element's frame to the link's
  int line = 0;                        // of the URDF
};

struct Inertial {
  double mass = 0;
  Point center = Point::Zero();                       // of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the centre of mass, along the link's axes
};

struct Link {
  std::string name;
  std::vector<Element> collision, visual;
  std::optional<Inertial> inertial;
  int line = 0;
};

enum class JointKind : std::uint8_t { fixed, revolute, continuous, prismatic, floating, planar };

struct JointLimits {
  double lower = 0, upper = 0;  // radians or metres
  double velocity = 0, effort = 0;
};

// The joint's value is multiplier * value of `joint` + offset.
struct Mimic {
  Index joint = 0;
  double multiplier = 1, offset = 0;
};

struct Joint {
  std::string name;
  JointKind kind = JointKind::fixed;
  Index parent = 0, child = 0;         // links
  Motion origin = Motion::Identity();  // from the child's frame at value 0 to the parent's
  Vector axis = Vector::UnitX();       // unit, in the child's frame
  std::optional<JointLimits> limits;   // of revolute and prismatic joints; of others only the velocity and effort count
  std::optional<Mimic> mimic;
  int line = 0;

  bool moves() const { return kind != JointKind::fixed; }
};

struct Robot {
  std::string name;
  std::filesystem::path file;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<std::string> notes;  // what was left out or had to be decided, a line each

  std::optional<Index> find_link(std::string_view link) const;
  std::optional<Index> find_joint(std::string_view joint) const;
  // The joint whose child the link is; nothing of a root.
  std::optional<Index> joint_above(Index link) const;
  // Joints that have a value of their own: of one degree of freedom, and not mimicking another, in the URDF's order.
  std::vector<Index> free_joints() const;
};

}  // namespace orchard::robot
