#pragma once
#include <vector>

#include "orchard/spheretree/sphere_set.h"

namespace orchard::detail {

struct ParticleSet {
  std::vector<Sphere> balls;  // the largest first
  ParticleFigures figures;
};

// Balls in the solid for the fit particles: as many as options.spheres, with overlaps that are allowed. Radii below
// options.min_radius and errors above those of options.particles are there where the search found nothing better.
ParticleSet particle_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress);

// The largest of: errors over what is allowed, and the smallest radius that is allowed over the smallest one. At most 1
// if nothing is missed.
double particle_excess(const ParticleSet& set, const SphereSetOptions& options, double diagonal);

}  // namespace orchard::detail
