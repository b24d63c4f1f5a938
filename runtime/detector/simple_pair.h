#pragma once
#include "detector/shapes.h"
#include "orchard/runtime/shape_query.h"

// Answers about pairs with a simple shape, in closed form or by one walk down one tree. They are correct up to rounding
// in double, as shape_query.h says, and cannot be interrupted. Round shapes and boxes are solid.
namespace orchard::runtime::detail {

// Returns "maybe" with an infinite bound.
Verdict unknown_verdict() noexcept;

// Tests two shapes. Preconditions: at least one of them is round, or `b` is a half-space; and the poses are rigid. The
// normal of a contact with a half-space points into it. `guess` is the tree's triangle that may be the nearest one, or
// kNoTriangle; it changes only the time.
Verdict test_simple(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    std::uint32_t guess = kNoTriangle) noexcept;

// Returns the lowest point of a shape, with its height over the plane as the distance. That is not finite if it is not
// known.
SurfacePoint lowest_point(const Shape& shape, const Pose& pose, const HalfSpace& half) noexcept;

// Returns how far `b`, which touches `a`, has to move along the normal of their verdict until the two are apart.
double simple_depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    const Vec3& normal) noexcept;

// Fills in up to four points and the depth of the contact of a shape with a half-space that it touches. The rest of the
// manifold stays as it is, and so does its point if no better one is found.
void half_space_contact(const Shape& a, const Pose& pose, const HalfSpace& b, Manifold& manifold) noexcept;

// Returns whether a connected piece of one shape lies inside the other one, which is a box, and then sets `contact`.
// Preconditions: both shapes have trees, and their surfaces do not touch.
bool inside_box(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Contact& contact) noexcept;

// Returns a lower bound on the distance, for conservative advancement. It is 0 if the shapes touch, or if nothing is
// known.
double half_space_distance(const Shape& a, const Pose& pose, const HalfSpace& b) noexcept;

}  // namespace orchard::runtime::detail
