#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "orchard/geometry/surface.h"

// Volumes and mass properties of unions of balls and of solids.
namespace orchard {

// A number that was estimated from samples.
struct Estimate {
  double value = 0;
  double error = 0;  // One standard error of the value.
};

// The mass properties of a homogeneous solid of density 1.
struct MassProperties {
  double volume = 0;                                  // In cubic mesh units.
  Point center = Point::Zero();                       // The centre of mass.
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // The inertia tensor about the centre of mass.
};

// The volumes and mass properties of a union of balls and a solid. Volumes are in cubic mesh units.
struct UnionVolume {
  Estimate balls;      // The union of the balls.
  Estimate outside;    // The part of the union outside the solid.
  Estimate uncovered;  // The part of the solid outside the union.
  double solid = 0;    // The solid: exact if it does not cut itself, otherwise an estimate.
  MassProperties of_balls, of_solid;
};

// Measures a union of balls against a solid by parallel rays, exactly along each ray. Eight independent sets of rays
// give the standard errors by their differences. With the default number of rays, the errors are about 0.1 % of the
// volumes; they are about inversely proportional to the number of rays. Throws InputError unless surface.solid(). Takes
// the time of outside_volume() with as many rays.
UnionVolume union_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t rays = 40'000);

// Returns the mass properties of the solid by the divergence theorem. They are exact, except that parts that the
// surface winds around twice count twice. Precondition: surface.solid().
MassProperties mass_properties(const Surface& surface);

// Returns |a - b| / |b| of two inertia tensors (Frobenius norm), each about its own centre of mass, at equal density,
// or with `a` scaled to the mass of `b` if `equal_mass` is true.
double inertia_difference(const MassProperties& a, const MassProperties& b, bool equal_mass);

}  // namespace orchard
