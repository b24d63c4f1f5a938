#pragma once
#include <optional>

#include "detector/shapes.h"
#include "orchard/runtime/shape_query.h"

// Queries about one placed shape. A tree is its surface, and a simple shape is a solid.
namespace orchard::runtime::detail {

// Returns the first point of the shape that the ray meets; `along` is in lengths of the ray's direction. Precondition:
// is_rigid(pose).
std::optional<RayHit> cast_ray(const Shape& shape, const Pose& pose, const Ray& ray) noexcept;

// Returns the point of the shape that is nearest to `point`. If it is farther than `limit`, there is no result: the
// distance is infinite.
SurfacePoint nearest_point(const Shape& shape, const Pose& pose, const Vec3& point, double limit) noexcept;

}  // namespace orchard::runtime::detail
