#pragma once
#include <span>

#include "nearest_sample.h"
#include "orchard/spheretree/sphere_audit.h"

namespace orchard::detail {

// Samples spread evenly over the boundary of a union of balls, and the distance to the boundary from inside.
class UnionBoundary {
 public:
  // `samples` is the approximate number of samples on all spheres together, including those inside other balls. Each
  // stands for its share of the area of its sphere.
  UnionBoundary(std::span<const Sphere> balls, Index samples);

  struct Sample {
    Point at;
    Index ball;
    double area;
  };
  // Returns the samples on the boundary, in the order of their balls.
  std::span<const Sample> samples() const { return samples_; }
  double area() const { return area_; }
  // Returns the distance from a point of the union to its boundary. It is the smallest distance to a sample, to a
  // projection onto a sphere and to a projection onto a circle where two spheres meet. It is never too small, and
  // nearly always exact.
  double depth(const Point& point) const;

 private:
  bool is_free(const Point& point, Index ball, Index other = kNone) const;
  double through_circles(const Point& point, Index ball, double least) const;
  void find_neighbors();

  std::span<const Sphere> balls_;
  double slack_;  // mesh units: a point deeper than this in another ball is not on the boundary
  std::vector<std::vector<Index>> neighbors_;
  std::vector<Sample> samples_;
  double area_ = 0;
  NearestSample nearest_;
};

// Returns point `i` of `n` points that are spread evenly over the unit sphere.
Vector on_sphere(Index i, Index n);

// Random points of a surface with a uniform density, and the distance of each from the union of the balls, 0 inside it.
struct SurfaceGaps {
  std::vector<Point> points;
  std::vector<double> gaps;
};
SurfaceGaps surface_gaps(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options);

MeanDistances mean_distances(const Surface& surface, std::span<const Sphere> balls, const SurfaceGaps& from,
                             const SphereAuditOptions& options);

// Returns cuRobo's figures. `volume` is the result of union_volume().
CuroboFigures curobo_figures(const Surface& surface, std::span<const Sphere> balls, const UnionVolume& volume,
                             const SurfaceGaps& from);

}  // namespace orchard::detail
