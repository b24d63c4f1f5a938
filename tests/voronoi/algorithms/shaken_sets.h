#pragma once
#include <cstdint>
#include <string>

#include "voronoi/point_sets.h"

// Small point sets that are nearly, but not quite, degenerate: neither rounding nor honest noise, they are what Voronoi
// algorithms fail on. Each is drawn from one of a few dozen families (lattices, points on planes, spheres, cones,
// cylinders, prisms and lines, near-duplicates, ..), in half of all cases turned, scaled or moved, and every one is
// shaken by something between 1e-16 and 1e-6 of its size.
namespace orchard::test {

struct ShakenSet {
  std::string name;  // family, number of points and noise, for messages
  Points points;     // 8 to some 300
};

// The same set for the same seed.
ShakenSet shaken_set(std::uint64_t seed);

std::size_t shaken_family_count();

}  // namespace orchard::test
