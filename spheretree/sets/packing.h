#pragma once
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/particles.h"

// Balls in a solid, of which no two overlap by more than is allowed.
namespace orchard::detail {

struct PackingOptions {
  Index balls = 1;
  double overlap = 0;       // as in ParticleOptions
  double least_radius = 0;  // mesh units; smaller balls are not placed
  std::uint64_t seed = 1;
  int rounds = 1;  // how long to search, as a multiple of the usual
};

// Places in the solid, spread evenly, with the largest balls around them that lie in it.
std::vector<Sphere> places_in(const Surface& surface, const PackingOptions& options);

// Balls of many sizes, at most `cap` large: again and again the largest one that finds room, moved to where it is
// larger; then each is moved to where it is larger. Fewer than `options.balls` where no more find room. O(n k) for k
// places.
std::vector<Sphere> pack_largest(const Surface& surface, const std::vector<Sphere>& places, double cap,
                                 const PackingOptions& options, const Progress& progress);

// Makes each ball as large as it may be beside the others, one after the other; none moves.
void grow_in_place(const Surface& surface, const PackingOptions& options, std::vector<Sphere>& balls);

// What moments a packing of equal balls is to have; nullptr: any.
struct PackingMoments {
  MassProperties body;
  double center_error = 0;   // mesh units
  double inertia_error = 0;  // relative
};

// Balls of one radius, as large as a search finds, that has the moments within the errors if it finds any. Balls push
// each other and the surface away while they grow. Empty if there is no place in the solid.
std::vector<Sphere> pack_equal(const Surface& surface, const std::vector<Sphere>& places, const PackingMoments* moments,
                               const PackingOptions& options, const Progress& progress);

}  // namespace orchard::detail
