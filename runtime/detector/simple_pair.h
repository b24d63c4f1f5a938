#pragma once
#include "detector/shapes.h"
#include "orchard/runtime/shape_query.h"

// Pairs with a simple shape: in closed form, or one walk down one tree. Correct to rounding in double, as shape_query.h
// says. None is interrupted. A round or box-shaped body is solid.
namespace orchard::runtime::detail {

Verdict unknown_verdict() noexcept;

// At least one of the two is round, or `b` is a half-space, into which the normal of a contact points then. The poses
// are rigid. `guess`: the tree's triangle that may be the nearest one, or none; it changes nothing but the time.
Verdict test_simple(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    std::uint32_t guess = kNoTriangle) noexcept;

// The lowest point of a shape and its height over the plane; not finite if that is not known.
SurfacePoint lowest_point(const Shape& shape, const Pose& pose, const HalfSpace& half) noexcept;

// How far the second one of a pair that touches has to move along the verdict's normal, until it does no more.
double simple_depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    const Vec3& normal) noexcept;

// Of a pair with a half-space that touches: up to four points and the depth. Leaves the rest of the manifold, and its
// point where there is no better one, as they are.
void half_space_contact(const Shape& a, const Pose& pose, const HalfSpace& b, Manifold& manifold) noexcept;

// Whether a piece of one lies wholly inside the other, which is a box. Precondition: their surfaces do not touch, and
// both have trees.
bool inside_box(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Contact& contact) noexcept;

// A lower bound on the distance, for advancing safely. 0 if they touch, or if nothing can be said.
double half_space_distance(const Shape& a, const Pose& pose, const HalfSpace& b) noexcept;

}  // namespace orchard::runtime::detail
