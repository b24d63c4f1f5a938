#include "robot/bodies.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "orchard/spheretree/union_volume.h"

namespace orchard::robot {
namespace {

// Of mass m at a distance from the centre of the whole.
Eigen::Matrix3d steiner(double mass, const Vector& arm) {
  return mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
}

Inertial of_spheres(std::span<const Sphere> spheres, double density) {
  Inertial body;
  const auto mass_of = [&](const Sphere& s) { return density * 4 * std::numbers::pi / 3 * std::pow(s.radius, 3); };
  for (const Sphere& sphere : spheres) {
    body.mass += mass_of(sphere);
    body.center += mass_of(sphere) * sphere.center;
  }
  body.center /= body.mass;
  for (const Sphere& sphere : spheres)
    body.inertia += steiner(mass_of(sphere), sphere.center - body.center) +
                    0.4 * mass_of(sphere) * sphere.radius * sphere.radius * Eigen::Matrix3d::Identity();
  return body;
}

}  // namespace

bool is_body(const Inertial& inertial) {
  if (!(inertial.mass > 0)) return false;
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertial.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  return moments[0] > 0 && moments[0] + moments[1] >= moments[2] * (1 - 1e-9);
}

Inertial body_of(const Link& link, const LinkShape* shape, std::span<const Sphere> spheres, double density) {
  if (link.inertial && is_body(*link.inertial)) return *link.inertial;
  if (shape == nullptr || !shape->surface.solid()) return of_spheres(spheres, density);
  const MassProperties solid = mass_properties(shape->surface);
  return {density * solid.volume, solid.center, density * solid.inertia};
}

}  // namespace orchard::robot
