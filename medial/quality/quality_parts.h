#pragma once
#include <span>
#include <vector>

#include "max_over_triangles.h"
#include "orchard/medial/quality.h"
#include "reconstruction.h"

// The metrics of medial_quality(), one file each. Lengths in mesh units; medial_quality() divides.
namespace orchard::detail {

struct SurfaceSample {
  Point position;
  Vector normal;  // outward
};

// Spread evenly over the area by their triangles, at random within each. Deterministic.
std::vector<SurfaceSample> quality_samples(const Surface& surface, Index count, std::uint64_t seed);

// Balls at vertices, at the middles of edges and of triangles, evenly chosen.
struct QualityBalls {
  std::vector<Sphere> all;              // those at vertices first, then those of edges
  std::size_t vertices = 0, edges = 0;  // how many these are

  std::span<const Sphere> at_vertices() const { return std::span(all).first(vertices); }
};
QualityBalls quality_balls(const MedialMesh& mesh, Index max);

// protruding_balls.cpp
// How deep in the solid a ball's centre is.
struct BallDepth {
  double signed_distance = 0;  // negative inside
  ClosestPoint nearest;        // of the surface
  bool outside() const { return signed_distance > 0; }
  // By more than rounding: a centre on a sharp edge may be on either side.
  bool outside_by(double negligible) const { return signed_distance > negligible; }
};
BallDepth depth_of(const Surface& surface, const Sphere& ball);
std::vector<BallDepth> depths_of(const Surface& surface, std::span<const Sphere> balls);
// How far a ball reaches outside the solid, and where to: no farther than its radius and the signed distance of its
// centre together.
struct BallReach {
  double beyond = 0;
  Point farthest = Point::Zero();
};
BallReach reach_of(const Surface& surface, const Sphere& ball, const BallDepth& depth);
// Of the places `known` and of where these balls protrude by more than `negligible`, the `count` worst: see worst_of().
// Fast, since the far sides of few balls are looked at.
std::vector<WorstPlace> worst_protrusions(const Surface& surface, std::span<const Sphere> balls,
                                          std::span<const BallDepth> depths, std::vector<WorstPlace> known, Index count,
                                          double apart, double negligible);

Spread spread_of(std::span<const double> values);

// quality_reconstruction.cpp
// How the boundary of the reconstruction lies to a point of the surface; lengths in mesh units.
struct SurfaceReach {
  double distance = 0;               // of the point to the reconstruction, minus the depth inside
  double uncovered = 0;              // distance to the reconstruction, 0 inside it
  double beyond = 0;                 // how far outside the solid it reaches along the normal
  double to_boundary = 0;            // distance of the point to its boundary; an upper bound where the point is inside
  double min_to_boundary = 0;        // and a lower one: the depth in the deepest ball
  bool arrived = true;               // `farthest` is a place of the boundary, or the point itself
  double from_boundary = 0;          // distance of a point of its boundary, that one or beside it, to the surface
  Point farthest = Point::Zero();    // where it reaches to, along the normal
  Sphere ball = {Point::Zero(), 0};  // the last one on the way
};
// Fastest where samples follow each other over the surface.
std::vector<SurfaceReach> reach_of(const Surface& surface, const Reconstruction& reconstruction,
                                   std::span<const SurfaceSample> samples, double diagonal);
void measure_reconstruction(const Surface& surface, const MedialMesh& mesh, std::span<const SurfaceSample> samples,
                            const QualityBalls& balls, std::span<const BallDepth> depths, const QualityOptions& options,
                            MedialQuality& quality);
// quality_coverage.cpp
// The largest distance of the surface from the reconstruction; `known`: what samples found.
MaxOverTriangles max_coverage(const Surface& surface, const Reconstruction& reconstruction, MaxOverTriangles known,
                              double diagonal);
// Of the samples, without the distances to balls at borders of sheets: those count as 0.
Spread inner_coverage(const MedialMesh& mesh, std::span<const SurfaceReach> reaches, double diagonal);
// worst_places.cpp
// The `count` worst of `places`, whichever their order, no two within `apart` of each other.
std::vector<WorstPlace> worst_of(std::vector<WorstPlace> places, Index count, double apart);
// quality_contacts.cpp
// |distance to the second contact - radius| over the radius; NaN if the ball has none, or is a point. `first`: the
// surface's place nearest to the centre.
double off_centre(const Surface& surface, const Sphere& ball, const ClosestPoint& first, double min_contact_angle,
                  double diagonal);
void measure_contacts(const Surface& surface, std::span<const Sphere> balls, std::span<const BallDepth> depths,
                      const QualityOptions& options, MedialQuality& quality);
// The distance from `center` to the part of the surface that is seen at `angle` or more from `direction` (unit), up to
// one in a thousand; infinity where there is none. Fastest where it is `likely` or a little less.
double second_contact_distance(const Surface& surface, const Point& center, const Vector& direction, double angle,
                               double likely);
// quality_economy.cpp
Economy measure_economy(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options, double diagonal);

}  // namespace orchard::detail
