#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "orchard/voronoi/diagram.h"
#include "predicates/predicates.h"

// Spheres of four points, and how precise they are.
namespace orchard::detail {

struct PlacedQuality {
  double volume6;    // as in RelativeCenter, as is the next one
  double condition;  // the factor by which rounding errors are magnified
  double shake;      // the factor for the noise of the input, over the smallest height of the tetrahedron
  double error;      // a bound on the error of (squared radius - squared distance) with this centre

  bool reliable() const { return condition * RelativeCenter::kCenterError < 0.125; }
};

struct PlacedSphere {
  Point center;
  double squared_radius;
  PlacedQuality quality;
};

// Computes the sphere of the new point and three others, which are given relative to it and whose coordinates may be
// off by the noise. The result is meaningless if it is not reliable.
inline PlacedSphere placed_sphere(const Point& new_point, double noise, const LengthedVector& a,
                                  const LengthedVector& b, const LengthedVector& c) {
  const RelativeCenter relative = circumcenter(a, b, c);
  // The reciprocal of the smallest height of the tetrahedron over the faces at the new point, which is the factor by
  // which the noise of the input is magnified.
  const double per_height = relative.max_face / std::abs(relative.volume6);
  const double shake = noise * per_height;
  const Point center = new_point + relative.center;
  // The rounded centre is used, so that at least the new point lies on the sphere.
  const double squared_radius = (center - new_point).squaredNorm();
  const double r = std::sqrt(squared_radius);
  // A centre off by e changes the power of a point about as far as the radius by less than 4 r e; e is kCenterError *
  // condition * r plus the rounding of the sum above plus what the input's noise does; and the power itself takes some
  // ten roundings of r^2.
  const double error =
      (4 * RelativeCenter::kCenterError * relative.condition + 16 * kRounding + 8 * shake) * squared_radius +
      8 * kRounding * r * center.lpNorm<1>();
  return {center, squared_radius, {relative.volume6, relative.condition, shake, error}};
}

// Limits within which a sphere is certainly good, as nearly all are: how thin its tetrahedron may be, how much it may
// magnify rounding errors, and how large its error bound may be over the squared radius. Error bounds are rounded up to
// a power of four times the smallest one, which is a power of two; the exponent is their class.
struct PlacingLimits {
  double noise, max_shake, max_condition, max_poverty, min_bound;
};

// The same with the same bits for four times three points at once, which become the centers and radii of four vertices.
struct FourTriangles {
  std::array<const LengthedVector*, 4> a, b, c;
};
struct FourQualities {
  std::array<double, 4> volume6, condition, shake, error;  // set unless all are good
  std::array<std::int64_t, 4> error_class;                 // set for those that are good
  unsigned good;                                           // a bit for each that is good by the limits
  PlacedQuality operator[](unsigned i) const { return {volume6[i], condition[i], shake[i], error[i]}; }
};
bool can_place_four();  // whether the machine has vectors of four doubles (AVX2), without which place_four() does
                        // nothing
void place_four(const Point& new_point, const PlacingLimits& limits, const FourTriangles& triangles,
                VoronoiVertex* vertices, FourQualities& qualities);

}  // namespace orchard::detail
