#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/covering/planar_cover.h"

namespace orchard::detail {

// Returns the exact sign of the area of the triangle (a, b, c), which is positive if the triangle runs
// counter-clockwise.
int exact_orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c);

// A directed edge of a polygon whose inside lies on its left.
struct Edge {
  PlanePoint a, b;
  int side_of(const PlanePoint& p) const { return exact_orientation(a, b, p); }  // positive if p is on the left
  bool on_line_of(const Edge& other) const { return other.side_of(a) == 0 && other.side_of(b) == 0; }
  // Points of an edge are given by their coordinate along the axis in which the edge is longer, so that its ends need
  // no rounding.
  int axis() const { return std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y()) ? 0 : 1; }
};

// Whether two edges certainly cross a third one in the same point, because they lie on one line or share a corner that
// is on the third edge.
bool cross_in_one_point(const Edge& p, const Edge& q, const Edge& crossed);

std::vector<Edge> edges_of(std::span<const PlanePoint> corners);

// Divides a simple polygon into triangles between its corners, counter-clockwise. Throws InputError if the polygon is
// not simple or has no area.
std::vector<std::array<PlanePoint, 3>> triangulated(std::span<const PlanePoint> polygon);

// Returns the corners in counter-clockwise order. Throws InputError unless they are finite and strictly convex.
std::vector<PlanePoint> convex_corners(std::span<const PlanePoint> corners);

}  // namespace orchard::detail
