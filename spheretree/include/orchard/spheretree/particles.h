#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/spheretree/union_volume.h"

// Sets of spheres that stand for a body in a particle simulation: overlaps, masses and moments.
namespace orchard {

struct ParticleOptions {
  // How much of the smaller ball of any pair may lie in the other one, as a part of its volume, 0..1; 0: balls may
  // touch, and no more.
  double overlap = 0;
  bool equal_radii = false;  // all radii are the same number
  // The density is that of the solid, whose mass the balls share in proportion to their volumes, or of each ball: then
  // the masses add up to what the balls' volumes do, overlaps counted twice.
  enum class DensityOf { solid, balls } density_of = DensityOf::solid;
  double density = 1;  // mass units per cubic mesh unit
  // Each ball has a mass of its own, 0 or more, as near to the usual one as can be while total mass, centre of mass and
  // inertia are those wanted.
  bool own_masses = false;
  double center_error = 0.005;  // of the centre of mass, as a fraction of the diagonal of the bounding box
  double inertia_error = 0.02;  // of the inertia tensor at equal mass, as inertia_difference() has it
};

// The volume that two balls share, over that of the smaller one: 0 where they are apart, 1 where one lies in the other.
double overlap_share(const Sphere& a, const Sphere& b);

// Whether overlap_share() is at most `share`, decided by exact arithmetic on the numbers given. Where the distance of
// the centres is no rational number, it is taken for less by a relative 2^-45: what is nearer than that to the limit
// counts as above it. A few microseconds where the balls are apart, some hundred otherwise.
bool overlaps_at_most(const Sphere& a, const Sphere& b, double share);

// A set of balls as one rigid body.
struct ParticleFigures {
  std::vector<double> masses;                      // of the balls, in their order; mass units
  MassProperties body;                             // of the balls together; `volume` is their mass
  double wanted_mass = 0;                          // mass units
  double center_error = 0;                         // how far the centre of mass is from the solid's, mesh units
  double inertia_error = 0;                        // at equal mass, relative
  double largest_overlap = 0;                      // of all pairs
  std::array<Index, 2> overlapping{kNone, kNone};  // the pair that has it
  bool overlap_proven = false;                     // that no pair is above what is allowed, by overlaps_at_most()
  double filled = 0;                               // the balls' volumes over the solid's
};

// Measures balls of the given masses beside a solid. O(n^2) for n balls, with exact arithmetic for pairs that meet.
// Precondition: as many masses as balls, of a sum above 0.
ParticleFigures particle_figures(std::span<const Sphere> balls, std::vector<double> masses, const MassProperties& solid,
                                 const ParticleOptions& options);

}  // namespace orchard
