#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// The boundary lemma for disks and convex polygons in the plane (dissertation, Appendix B).
namespace orchard {

using PlanePoint = Eigen::Vector2d;

// A closed shape: a disk, or a convex polygon.
struct PlanarShape {
  // The corners of a convex polygon in order, in either direction; empty for a disk.
  std::vector<PlanePoint> corners;
  PlanePoint center = PlanePoint::Zero();
  double radius = 0;

  static PlanarShape disk(const PlanePoint& center, double radius) { return {{}, center, radius}; }
  // Returns a rectangle with sides along the axes.
  static PlanarShape rectangle(const PlanePoint& lower, const PlanePoint& upper);
  static PlanarShape polygon(std::vector<PlanePoint> corners) { return {std::move(corners)}; }
};

// A piece of a shape's boundary inside the region such that the points just outside the shape are not certified to be
// covered.
struct PlanarGap {
  Index shape = kNone;            // The shape, as an index.
  PlanePoint begin, middle, end;  // Points of the piece.
};

// The result of cover_of_polygon().
struct PlanarCover {
  bool covered = false;                     // Certified: every point of the region lies in some shape.
  PlanePoint witness = PlanePoint::Zero();  // If not covered: a point near which the cover is not certain.
  std::vector<PlanarGap> gaps;              // If not covered, and if a boundary crosses the region.
};

// Decides whether shapes cover a simple polygon, whose corners are in order in either direction.
// Polygons may abut: there is no gap between two shapes with edges on the same line, one on each side of it. Whether
// two edges lie on the same line is decided exactly from their coordinates. There is no gap either at a point where two
// such edges, or two edges with a common corner, cross a third edge. All other shapes that merely touch leave a gap.
// Throws InputError if the region crosses itself, a polygon is not strictly convex, a radius is not positive or a
// coordinate is not finite. O(n m) for n boundary pieces and the m shapes whose boxes meet each.
PlanarCover cover_of_polygon(std::span<const PlanePoint> region, std::span<const PlanarShape> shapes);

}  // namespace orchard
