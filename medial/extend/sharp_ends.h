#pragma once
#include "../features/sharp_edges.h"
#include "borders.h"

// Where the sheets at a ball end on the surface: what the searches for edges and corners have in common.
namespace orchard::detail {

// From the centre of a ball to where the tangent planes at two of its contacts meet next to it. False where they meet
// farther away than `kMaxApex` radii.
bool apex_of_two(const ExactBall& ball, int i, int j, Vector& to_apex);
// To where those at three of them meet.
bool apex_of_three(const ExactBall& ball, int i, int j, int k, Vector& to_apex);
inline constexpr double kMaxApex = 4;

// Part of the way to the apex: how far from there the edge or corner may be, surfaces not being planes.
inline constexpr double kMaxFoot = 0.25;

// Spacings, from a ball to an edge or a corner.
inline constexpr double kMaxReach = 8;

// Whether the balls between an exact one and a place of the surface, where the radius is 0, are right.
bool is_way_right(const Surface& surface, const ExactBall& ball, const Point& end, double tolerance);

// Whether the balls in the middle of a triangle, and of its edge bc, are right up to kBorderSlack tolerances.
bool is_triangle_right(const Surface& surface, const ExactBall& a, const ExactBall& b, const ExactBall& c,
                       double tolerance);

// The ball of radius 0 at a place of a sharp edge.
ExactBall ball_on_edge(const ClosestPoint& place);

}  // namespace orchard::detail
