#pragma once
#include <optional>

#include "orchard/covering/planar_cover.h"

namespace orchard::construction_methods {

// A piece of a boundary whose y ascends: a segment, or half of a circle.
struct MonotoneCurve {
  double low = 0, high = 0;  // y
  int enters = 0;            // a shape's boundary: +1 if the shape lies on its right, -1 on its left; the region's: 0
  int side = 0;              // of the circle: -1 the left half, 1 the right one; 0: a segment
  PlanePoint center = PlanePoint::Zero();  // of the circle, or a point of the segment
  double radius = 0;
  double slope = 0;    // dx/dy of the segment
  Index next = kNone;  // the curve that goes on where this one ends

  double x_at(double y) const;
  double slope_at(double y) const;  // infinite at the lowest and the highest point of a circle
};

// The y at which `a`, left of `b` before, is right of it afterwards. Two curves have at most one for each order.
std::optional<double> overtaking(const MonotoneCurve& a, const MonotoneCurve& b);

}  // namespace orchard::construction_methods
