#pragma once
#include <cstddef>
#include <span>

#include "orchard/covering/planar_cover.h"

namespace orchard::construction_methods {

struct SweptCover {
  bool covered = false;
  PlanePoint witness = PlanePoint::Zero();  // if not covered: a point of the gap that was found first
  std::size_t crossings = 0;                // of boundaries, that the sweep passed
};

// The sweep that Appendix B leaves to others: whether shapes with few boundary curves of ascending y cover a polygon.
// A line moves upwards through all curves (Bentley and Ottmann); between two neighbours it knows how many shapes hold
// what lies there, and whether that is inside the region. The first place inside that none holds ends it. The same
// question as cover_of_polygon(), without its proof: numbers are rounded, and gaps thinner than 1e-12 of the region's
// size pass as covered. Throws InputError as that does for shapes; the region is taken as simple.
// O(c log n + n a) for n curves, c crossings and a curves on the line.
SweptCover cover_by_sweep(std::span<const PlanePoint> region, std::span<const PlanarShape> shapes);

}  // namespace orchard::construction_methods
