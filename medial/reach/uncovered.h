#pragma once
#include <array>
#include <span>
#include <vector>

#include "../quality/reconstruction.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of the surface that the balls of an axis leave open, or that has a dent of theirs below it.
struct UncoveredPlace {
  double value = 0;  // mesh units: the distance to the nearest ball, or to the dent
  Point position = Point::Zero();
  Point inside = Point::Zero();  // where the nearest ball is looked for: the place itself, or the dent
};

// The worst first, no two with `inside` within `apart` of each other. Of equal ones position decides. O(n log n).
std::vector<UncoveredPlace> worst_apart(std::vector<UncoveredPlace> places, double apart, const Box& box);

// Looks for such places again and again while the axis grows.
class UncoveredSearch {
 public:
  // For what is left open by more than `limit`; triangles are divided until what is left of them reaches no farther
  // than `resolution` if it is open, and than `detail`, which is no more, if it may be: so what is not found is left
  // open by less than `limit` and `detail`. Mesh units.
  UncoveredSearch(const Surface& surface, double limit, double resolution, double detail);
  // For what of `parts`, triangles below the surface, is in no ball and not nearer to the surface than `depth`. They
  // are divided until what is left of them reaches no farther than `resolution`.
  UncoveredSearch(const Surface& surface, std::vector<std::array<Point, 3>> parts, double depth, double resolution);

  // The worst first, no two within `apart` of each other. After the first time only the parts of the surface that may
  // have been open then are looked at. Parallel, deterministic: a query for every few triangles, and some for each part
  // that is open.
  std::vector<UncoveredPlace> find(const Reconstruction& reconstruction, double apart);
  // Where balls in these spheres are no longer there, the next find() looks again. O(s n).
  void look_again(std::span<const Sphere> spheres);

 private:
  double enough(double reach) const;
  struct Block;  // what one task looks at
  void look_at(const Reconstruction& reconstruction, Block& block) const;
  Block look_at_all(const Reconstruction& reconstruction, const std::vector<std::array<Point, 3>>& parts) const;

  const Surface& surface_;
  const double limit_, resolution_, detail_, depth_;
  const std::vector<std::array<Point, 3>> given_;
  std::vector<std::array<Point, 3>> parts_;  // triangles, or points: three times the same
  bool with_corners_ = true;                 // whether there may be given parts among these
};

}  // namespace orchard::detail
