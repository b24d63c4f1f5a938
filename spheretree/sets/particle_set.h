#pragma once
#include <vector>

#include "orchard/spheretree/sphere_set.h"

namespace orchard::detail {

struct ParticleSet {
  std::vector<Sphere> balls;  // the largest first
  ParticleFigures figures;
};

// Returns options.spheres balls in the solid with allowed overlaps, for the fit `particles`. If the search finds
// nothing better, radii may be below options.min_radius and errors above those of options.particles.
ParticleSet particle_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress);

// Returns the largest ratio by which a set misses its requirements: of an error to the allowed error, or of the
// required smallest radius to the smallest radius. It is at most 1 if all requirements are met.
double particle_excess(const ParticleSet& set, const SphereSetOptions& options, double diagonal);

}  // namespace orchard::detail
