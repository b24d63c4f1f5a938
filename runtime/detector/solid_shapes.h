#pragma once
#include <optional>

#include "detector/shapes.h"
#include "orchard/runtime/shape_query.h"

// Questions about one placed shape: trees by their surfaces, simple shapes as solids.
namespace orchard::runtime::detail {

// The first point of the shape that the ray meets, `along` in lengths of its direction. Precondition: is_rigid(pose).
std::optional<RayHit> cast_ray(const Shape& shape, const Pose& pose, const Ray& ray) noexcept;

// The point of the shape nearest to this one; farther than `limit`: none, and the distance is infinite.
SurfacePoint nearest_point(const Shape& shape, const Pose& pose, const Vec3& point, double limit) noexcept;

}  // namespace orchard::runtime::detail
