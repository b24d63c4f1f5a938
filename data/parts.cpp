#include "parts.h"

#include <cmath>

namespace orchard::models {

Loop grow_rings(SolidBuilder& solid, Loop from, const Frame& frame, const Section& section,
                const std::vector<Ring>& rings) {
  for (const Ring& ring : rings) {
    from = solid.grow(from, frame.ahead(ring.height), scaled(section, ring.scale));
  }
  return from;
}

void grow_ball(SolidBuilder& solid, const Loop& from, const Frame& frame, const Section& section, double neck,
               double radius, int bands) {
  const double first = std::asin(neck / radius);
  const double centre = radius * std::cos(first);
  std::vector<Ring> rings;
  for (int i = 1; i < bands; ++i) {
    const double angle = first + (kPi - first) * i / bands;
    rings.push_back({centre - radius * std::cos(angle), radius * std::sin(angle) / neck});
  }
  const Loop last = grow_rings(solid, from, frame, section, rings);
  solid.add_tip(last, frame.ahead(centre + radius).origin);
}

}  // namespace orchard::models
