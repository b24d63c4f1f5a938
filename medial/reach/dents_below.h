#pragma once
#include <vector>

#include "../quality/reconstruction.h"
#include "orchard/geometry/surface.h"
#include "uncovered.h"

namespace orchard::detail {

// Looks for dents between the balls of an axis, again and again while it grows: places that the balls reach from
// nowhere, though what is above them is left open by little, since balls stand around it.
class DentsBelow {
 public:
  // For dents deeper than 1.1 `limit` and wider than `resolution`: what is `limit` below the surface, along its
  // normals, is looked at as by UncoveredSearch. What is below reflex edges alone is not. Mesh units.
  DentsBelow(const Surface& surface, double limit, double resolution);

  // The deepest first; no two within `apart` of each other. As UncoveredSearch::find().
  std::vector<UncoveredPlace> find(const Reconstruction& reconstruction, double apart);
  // As UncoveredSearch::look_again().
  void look_again(std::span<const Sphere> spheres) { below_.look_again(spheres); }

 private:
  UncoveredPlace bottom_below(const UncoveredPlace& place, const Point& above,
                              const Reconstruction& reconstruction) const;

  const Surface& surface_;
  const double limit_;
  UncoveredSearch below_;
};

}  // namespace orchard::detail
