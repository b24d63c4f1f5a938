#include "detector/solid_shapes.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::detail {
namespace {

// Returns the smaller root of a t^2 + 2 b t + c, or infinity if there is none or it is negative.
double first_root(double a, double b, double c) noexcept {
  const double h = b * b - a * c;
  if (!(a > 0) || !(h >= 0)) return kInfinity;
  const double t = (-b - std::sqrt(h)) / a;
  return t >= 0 ? t : kInfinity;
}

// Returns the first t >= 0 at which origin + t way is within `radius` of the segment from p to q, or infinity.
double enters_capsule(const Vec3& p, const Vec3& q, double radius, const Vec3& origin, const Vec3& way) noexcept {
  const Vec3 from = origin - nearest_of_segment(p, q, origin);
  if (dot(from, from) <= radius * radius) return 0;
  const double square = dot(way, way);
  double first = kInfinity;
  for (const Vec3& end : {p, q}) {
    const Vec3 m = origin - end;
    first = std::min(first, first_root(square, dot(way, m), dot(m, m) - radius * radius));
  }
  const Vec3 axis = q - p, m = origin - p;
  const double aa = dot(axis, axis), aw = dot(axis, way), am = dot(axis, m);
  const double side =
      first_root(aa * square - aw * aw, aa * dot(way, m) - am * aw, aa * dot(m, m) - am * am - radius * radius * aa);
  const double foot = am + side * aw;
  return foot >= 0 && foot <= aa ? std::min(first, side) : first;
}

double enters_half_space(const HalfSpace& half, const Vec3& origin, const Vec3& way) noexcept {
  const double height = dot(half.normal, origin) - half.offset, sinks = -dot(half.normal, way);
  return height <= 0 ? 0 : sinks > 0 ? height / sinks : kInfinity;
}

}  // namespace

std::optional<RayHit> cast_ray(const Shape& shape, const Pose& pose, const Ray& ray) noexcept {
  if (shape.kind == ShapeKind::tree) return cast_ray(shape.tree, pose, ray.origin, ray.direction, ray.longest);
  const Pose back = inverse(pose);
  const Vec3 origin = transform(back, ray.origin), way = back.scale * Vec3(rotate(back, ray.direction));
  const double along = shape.kind == ShapeKind::box     ? enters_box(-shape.p, shape.p, origin, way, kInfinity)
                       : shape.kind == ShapeKind::round ? enters_capsule(shape.p, shape.q, shape.radius, origin, way)
                                                        : enters_half_space(shape.half, origin, way);
  if (!(along <= ray.longest) || along == kInfinity) return std::nullopt;
  return RayHit{along, Vec3(ray.origin) + along * Vec3(ray.direction), kNoTriangle};
}

SurfacePoint nearest_point(const Shape& shape, const Pose& pose, const Vec3& point, double limit) noexcept {
  if (shape.kind == ShapeKind::tree) return nearest_point(shape.tree, pose, point, limit);
  const Vec3 at = transform(inverse(pose), point);
  Vec3 near = at;
  SurfacePoint result;
  if (shape.kind == ShapeKind::half_space) {
    result.distance = std::max(0.0, dot(shape.half.normal, at) - shape.half.offset);
    near = at - result.distance * shape.half.normal;
  } else if (shape.kind == ShapeKind::box) {
    for (std::size_t i = 0; i < 3; ++i) near[i] = std::clamp(at[i], -shape.p[i], shape.p[i]);
  } else {
    const Vec3 middle = nearest_of_segment(shape.p, shape.q, at), way = at - middle;
    const double size = length(way);
    if (size > shape.radius) near = middle + (shape.radius / size) * way;
  }
  if (shape.kind != ShapeKind::half_space) result.distance = length(at - near) * pose.scale;
  if (!(result.distance <= limit)) return {};
  result.point = result.distance == 0 ? point : Vec3(transform(pose, near));
  return result;
}

}  // namespace orchard::runtime::detail
