#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/spheretree/union_volume.h"

// Sets of spheres that stand for a body in a particle simulation: overlaps, masses and moments.
namespace orchard {

// The requirements on a set of particles.
struct ParticleOptions {
  // The largest part of the smaller ball's volume, in 0..1, that may lie in the other ball of a pair. With 0, balls may
  // touch but not overlap.
  double overlap = 0;
  bool equal_radii = false;  // Whether all radii are the same number.
  // Which body has the density. With `solid`, the balls share the mass of the solid in proportion to their volumes.
  // With `balls`, each ball has the density, so the masses add up to the sum of the balls' volumes, which counts
  // overlaps twice.
  enum class DensityOf { solid, balls } density_of = DensityOf::solid;
  double density = 1;  // The density in mass units per cubic mesh unit.
  // Whether each ball gets its own mass, at least 0. The masses are as near to the usual ones as possible while total
  // mass, centre of mass and inertia have the required values.
  bool own_masses = false;
  // The largest error of the centre of mass, as a fraction of the diagonal of the bounding box.
  double center_error = 0.005;
  // The largest error of the inertia tensor at equal mass, as defined by inertia_difference().
  double inertia_error = 0.02;
};

// Returns the volume that two balls share over the volume of the smaller one: 0 if they are apart, 1 if one lies in the
// other.
double overlap_share(const Sphere& a, const Sphere& b);

// Returns whether overlap_share() is at most `share`, decided by exact arithmetic on the given numbers. If the distance
// of the centres is irrational, a value that is smaller by a relative 2^-45 replaces it, so a pair nearer than that to
// the limit counts as above it. Takes a few microseconds if the balls are apart, otherwise some hundred.
bool overlaps_at_most(const Sphere& a, const Sphere& b, double share);

// Measures of a set of balls as one rigid body.
struct ParticleFigures {
  std::vector<double> masses;                      // The masses of the balls in their order, in mass units.
  MassProperties body;                             // The balls together; `volume` holds their mass.
  double wanted_mass = 0;                          // The required mass, in mass units.
  double center_error = 0;                         // Distance of the centre of mass from the solid's, in mesh units.
  double inertia_error = 0;                        // Relative error of the inertia at equal mass.
  double largest_overlap = 0;                      // The largest overlap_share() of all pairs.
  std::array<Index, 2> overlapping{kNone, kNone};  // The pair that has the largest overlap.
  // Whether overlaps_at_most() proves that no pair overlaps by more than is allowed.
  bool overlap_proven = false;
  double filled = 0;  // The sum of the balls' volumes over the solid's volume.
};

// Measures balls of the given masses against a solid. Precondition: there are as many masses as balls, and their sum is
// above 0. Takes O(n^2) for n balls, with exact arithmetic for pairs that meet.
ParticleFigures particle_figures(std::span<const Sphere> balls, std::vector<double> masses, const MassProperties& solid,
                                 const ParticleOptions& options);

}  // namespace orchard
