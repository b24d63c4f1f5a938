#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "orchard/spheretree/sphere_set.h"

// What is said of a set of spheres as a body in a particle simulation. `diagonal`: of the solid's bounding box.
namespace orchard::apps {

std::string particle_promise(const SphereSetOptions& options);
// What is above its limit, in words with figures.
std::vector<std::string> missed_by_particles(const SphereSetOptions& options, const ParticleFigures& figures,
                                             double diagonal);

nlohmann::json to_json(const ParticleFigures& figures, double diagonal);
// Of any set with masses, and of one that was made with a promise.
void print_bodies(const ParticleFigures& figures, double diagonal);
void print_particles(const ParticleFigures& figures, double diagonal);

}  // namespace orchard::apps
