#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/covering/planar_cover.h"

namespace orchard::detail {

// Sign of the area of the triangle (a, b, c), exactly: > 0 if it runs counter-clockwise.
int exact_orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c);

// A directed edge of a polygon whose inside lies on its left.
struct Edge {
  PlanePoint a, b;
  int side_of(const PlanePoint& p) const { return exact_orientation(a, b, p); }  // > 0: on the left
  bool on_line_of(const Edge& other) const { return other.side_of(a) == 0 && other.side_of(b) == 0; }
  // Points of an edge are told by their coordinate along the axis it is longer in: corners need no rounding there.
  int axis() const { return std::abs(b.x() - a.x()) >= std::abs(b.y() - a.y()) ? 0 : 1; }
};

// Two edges cross a third one in the same point for sure: they lie on one line, or share a corner that lies on it.
bool cross_in_one_point(const Edge& p, const Edge& q, const Edge& crossed);

std::vector<Edge> edges_of(std::span<const PlanePoint> corners);

// A simple polygon cut into triangles between its corners, counter-clockwise. Throws InputError if it is not simple or
// has no area.
std::vector<std::array<PlanePoint, 3>> triangulated(std::span<const PlanePoint> polygon);

// The corners counter-clockwise. Throws InputError unless they are finite and strictly convex.
std::vector<PlanePoint> convex_corners(std::span<const PlanePoint> corners);

}  // namespace orchard::detail
