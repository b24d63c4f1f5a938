#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/particles.h"

// Packs balls in a solid so that no two overlap by more than is allowed.
namespace orchard::detail {

struct PackingOptions {
  Index balls = 1;
  double overlap = 0;       // as in ParticleOptions
  double least_radius = 0;  // in mesh units: smaller balls are not placed
  std::uint64_t seed = 1;
  int rounds = 1;  // the effort of the search, as a multiple of the usual one
};

// Returns places spread evenly in the solid, with the largest balls around them that lie in it.
std::vector<Sphere> places_in(const Surface& surface, const PackingOptions& options);

// Packs balls of different sizes, with radii of at most `cap`. It repeatedly adds the largest ball that has room, moved
// to where it can be larger, and finally moves each ball to where it can be larger. Returns fewer than `options.balls`
// if no more have room. O(n k) for k places.
std::vector<Sphere> pack_largest(const Surface& surface, const std::vector<Sphere>& places, double cap,
                                 const PackingOptions& options, const Progress& progress);

// Enlarges each ball as far as the others allow, one after another, without moving any.
void grow_in_place(const Surface& surface, const PackingOptions& options, std::vector<Sphere>& balls);

// The moments that a packing of equal balls should have; nullptr for any.
struct PackingMoments {
  MassProperties body;
  double center_error = 0;   // in mesh units
  double inertia_error = 0;  // relative to the wanted inertia
};

// Packs balls of one radius, the largest that a search finds, with moments within the errors if it finds such a
// packing. The balls push each other and the surface away while they grow. Returns an empty packing if there is no
// place in the solid.
std::vector<Sphere> pack_equal(const Surface& surface, const std::vector<Sphere>& places, const PackingMoments* moments,
                               const PackingOptions& options, const Progress& progress);

}  // namespace orchard::detail
