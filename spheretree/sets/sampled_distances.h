#pragma once
#include <span>

#include "nearest_sample.h"
#include "orchard/spheretree/sphere_audit.h"

namespace orchard::detail {

// Points spread evenly over the boundary of a union of balls, and the distance to it from inside.
class UnionBoundary {
 public:
  // About so many samples on all spheres together, those inside other balls included; each stands for its share of its
  // sphere's area.
  UnionBoundary(std::span<const Sphere> balls, Index samples);

  struct Sample {
    Point at;
    Index ball;
    double area;
  };
  // Those on the boundary, ball by ball.
  std::span<const Sample> samples() const { return samples_; }
  double area() const { return area_; }
  // The distance from a point of the union to its boundary: by the nearest sample, its projection onto spheres and onto
  // the circles where two spheres meet. Never too small, and exact as a rule.
  double depth(const Point& point) const;

 private:
  bool is_free(const Point& point, Index ball, Index other = kNone) const;
  double through_circles(const Point& point, Index ball, double least) const;
  void find_neighbors();

  std::span<const Sphere> balls_;
  double slack_;  // mesh units: what is deeper in another ball is not on the boundary
  std::vector<std::vector<Index>> neighbors_;
  std::vector<Sample> samples_;
  double area_ = 0;
  NearestSample nearest_;
};

// Point `i` of `n` spread evenly over the unit sphere.
Vector on_sphere(Index i, Index n);

// Random points of a surface, as many on equal areas, and how far each is from the union of the balls: 0 in it.
struct SurfaceGaps {
  std::vector<Point> points;
  std::vector<double> gaps;
};
SurfaceGaps surface_gaps(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options);

MeanDistances mean_distances(const Surface& surface, std::span<const Sphere> balls, const SurfaceGaps& from,
                             const SphereAuditOptions& options);

// `volume` as union_volume() has it.
CuroboFigures curobo_figures(const Surface& surface, std::span<const Sphere> balls, const UnionVolume& volume,
                             const SurfaceGaps& from);

}  // namespace orchard::detail
