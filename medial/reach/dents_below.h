#pragma once
#include <vector>

#include "../quality/reconstruction.h"
#include "orchard/geometry/surface.h"
#include "uncovered.h"

namespace orchard::detail {

// Finds dents between the balls of an axis: places inside the solid that lie deep below the surface and that no ball
// holds, although the surface above them is left open by little, because balls stand around it. It may be asked again
// and again while the axis grows.
class DentsBelow {
 public:
  // Finds dents deeper than 1.1 `limit` and wider than `resolution` (mesh units), by an UncoveredSearch of the places
  // that lie `limit` below the surface along its normals. Places that are only below reflex edges are not searched.
  DentsBelow(const Surface& surface, double limit, double resolution);

  // Like UncoveredSearch::find(): the deepest first, and no two within `apart` of each other.
  std::vector<UncoveredPlace> find(const Reconstruction& reconstruction, double apart);
  // See UncoveredSearch::look_again().
  void look_again(std::span<const Sphere> spheres) { below_.look_again(spheres); }

 private:
  UncoveredPlace bottom_below(const UncoveredPlace& place, const Point& above,
                              const Reconstruction& reconstruction) const;

  const Surface& surface_;
  const double limit_;
  UncoveredSearch below_;
};

}  // namespace orchard::detail
