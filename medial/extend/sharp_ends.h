#pragma once
#include "../features/sharp_edges.h"
#include "borders.h"

// Where the sheets at a ball end on the surface: what the searches for edges and for corners share.
namespace orchard::detail {

// Computes the vector from a ball's centre to the nearest point of the line in which the tangent planes at two of its
// contacts meet. Returns false if that is farther away than `kMaxApex` radii.
bool apex_of_two(const ExactBall& ball, int i, int j, Vector& to_apex);
// The same for the point in which the tangent planes at three contacts meet.
bool apex_of_three(const ExactBall& ball, int i, int j, int k, Vector& to_apex);
inline constexpr double kMaxApex = 4;

// A part of the distance to the apex: the edge or corner may be this far from the apex, since surfaces are not planes.
inline constexpr double kMaxFoot = 0.25;

// In spacings: the most that a ball may be away from an edge or a corner.
inline constexpr double kMaxReach = 8;

// Whether the balls between an exact one and a place of the surface (with radius 0) are right within the tolerance.
bool is_way_right(const Surface& surface, const ExactBall& ball, const Point& end, double tolerance);

// Whether the balls in the middle of a triangle and of its edge bc are right within kBorderSlack tolerances.
bool is_triangle_right(const Surface& surface, const ExactBall& a, const ExactBall& b, const ExactBall& c,
                       double tolerance);

// The ball of radius 0 at a place of a sharp edge.
ExactBall ball_on_edge(const ClosestPoint& place);

}  // namespace orchard::detail
