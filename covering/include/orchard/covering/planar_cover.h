#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// The boundary lemma for shapes of the plane in general (dissertation, Appendix B).
namespace orchard {

using PlanePoint = Eigen::Vector2d;

// A closed shape: a disk, or the convex hull of `corners` in order.
struct PlanarShape {
  std::vector<PlanePoint> corners;  // of a convex polygon, either way round; empty: a disk
  PlanePoint center = PlanePoint::Zero();
  double radius = 0;

  static PlanarShape disk(const PlanePoint& center, double radius) { return {{}, center, radius}; }
  static PlanarShape rectangle(const PlanePoint& lower, const PlanePoint& upper);  // sides along the axes
  static PlanarShape polygon(std::vector<PlanePoint> corners) { return {std::move(corners)}; }
};

// A piece of a shape's boundary inside the region beyond which nothing is certain to be covered.
struct PlanarGap {
  Index shape = kNone;
  PlanePoint begin, middle, end;
};

struct PlanarCover {
  bool covered = false;                     // certified: every point of the region lies in some shape
  PlanePoint witness = PlanePoint::Zero();  // if not: a point near which that is not certain
  std::vector<PlanarGap> gaps;              // if not, and a boundary runs through the region
};

// Whether the shapes cover a simple polygon, either way round. Polygons may abut: where two edges lie on one line,
// told exactly from their coordinates, and the shapes on opposite sides of it, there is no gap; nor at a point where
// edges of one line, or with a corner in common, cross a third edge. What is tangent otherwise is not covered. Throws
// InputError if the region crosses itself, a polygon is not strictly convex, a radius is not positive or a coordinate
// is not finite.
// O(n m) for n boundary pieces and the m shapes whose boxes meet each.
PlanarCover cover_of_polygon(std::span<const PlanePoint> region, std::span<const PlanarShape> shapes);

}  // namespace orchard
