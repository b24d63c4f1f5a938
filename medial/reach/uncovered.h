#pragma once
#include <array>
#include <span>
#include <vector>

#include "../quality/reconstruction.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of the surface that the balls of an axis leave open, or that has a dent of the reconstruction below it.
struct UncoveredPlace {
  double value = 0;  // the distance to the nearest ball or to the dent, in mesh units
  Point position = Point::Zero();
  Point inside = Point::Zero();  // where a ball is to be placed: the place itself, or the dent
};

// Returns the places with the largest values first, of which no two have their `inside` within `apart` of each other.
// Equal values are ordered by position. O(n log n).
std::vector<UncoveredPlace> worst_apart(std::vector<UncoveredPlace> places, double apart, const Box& box);

// Searches for such places repeatedly while the axis grows.
class UncoveredSearch {
 public:
  // Searches for places that are open by more than `limit`. Triangles are divided until an open part reaches no farther
  // than `resolution`, and a part that may be open no farther than `detail`, which is at most `resolution`. So places
  // that are not found are open by less than the sum of `limit` and `detail`. All are in mesh units.
  UncoveredSearch(const Surface& surface, double limit, double resolution, double detail);
  // Searches for places on `parts`, triangles below the surface, that are in no ball and not nearer to the surface than
  // `depth`. Parts are divided until such a place reaches no farther than `resolution`.
  UncoveredSearch(const Surface& surface, std::vector<std::array<Point, 3>> parts, double depth, double resolution);

  // Returns the worst places first, no two within `apart` of each other. After the first call, only parts of the
  // surface that may have been open then are examined. Parallel, deterministic. Costs one query for every few
  // triangles, and some for each part that is open.
  std::vector<UncoveredPlace> find(const Reconstruction& reconstruction, double apart);
  // The next find() also examines places near these spheres, because their balls have been removed. O(s n).
  void look_again(std::span<const Sphere> spheres);

 private:
  double enough(double reach) const;
  struct Block;  // a group of parts that one task examines
  void look_at(const Reconstruction& reconstruction, Block& block) const;
  Block look_at_all(const Reconstruction& reconstruction, const std::vector<std::array<Point, 3>>& parts) const;

  const Surface& surface_;
  const double limit_, resolution_, detail_, depth_;
  const std::vector<std::array<Point, 3>> given_;
  std::vector<std::array<Point, 3>> parts_;  // triangles, or points as degenerate triangles
  bool with_corners_ = true;                 // whether the parts may include given ones rather than halves only
};

}  // namespace orchard::detail
