#include "orchard/geometry/sphere_distance.h"

#include <algorithm>
#include <array>
#include <limits>

namespace orchard {
namespace {

// Returns the 20 vertices of a dodecahedron on the unit sphere: the 8 corners of a cube and the 12 of three golden
// rectangles.
std::array<Vector, 20> dodecahedron() {
  constexpr double kPhi = 1.618033988749895, kCube = 0.5773502691896258;
  std::array<Vector, 20> vertices;
  std::size_t count = 0;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) vertices[count++] = kCube * Vector(x, y, z);
      const double shorter = x * kCube / kPhi, longer = y * kCube * kPhi;
      vertices[count++] = Vector(0, shorter, longer);
      vertices[count++] = Vector(shorter, longer, 0);
      vertices[count++] = Vector(longer, 0, shorter);
    }
  return vertices;
}

// The result is negative if all vertices lie inside the solid.
double max_signed_distance(const Surface& surface, const Sphere& sphere) {
  static const std::array<Vector, 20> directions = dodecahedron();
  double max = -std::numeric_limits<double>::infinity();
  for (const Vector& direction : directions)
    max = std::max(max, surface.signed_distance(sphere.center + sphere.radius * direction));
  return max;
}

}  // namespace

double convex_sphere_distance(const Surface& surface, const Sphere& sphere) {
  return std::max(0.0, sphere.radius + surface.signed_distance(sphere.center));
}

double sampled_sphere_distance(const Surface& surface, const Sphere& sphere) {
  return std::max(0.0, max_signed_distance(surface, sphere));
}

double corrected_sphere_distance(const Surface& surface, const Sphere& sphere) {
  return std::max(0.0, max_signed_distance(surface, sphere) + kDodecahedronGap * sphere.radius);
}

}  // namespace orchard
