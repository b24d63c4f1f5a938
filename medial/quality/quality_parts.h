#pragma once
#include <span>
#include <vector>

#include "max_over_triangles.h"
#include "orchard/medial/quality.h"
#include "reconstruction.h"

// The metrics of medial_quality(), each in a file of its own. Lengths are in mesh units; medial_quality() divides them
// by the diagonal.
namespace orchard::detail {

struct SurfaceSample {
  Point position;
  Vector normal;  // outward
};

// Returns samples spread evenly over the area: their number on each triangle is proportional to its area, and their
// places are random. Deterministic.
std::vector<SurfaceSample> quality_samples(const Surface& surface, Index count, std::uint64_t seed);

// Balls at vertices, at the middles of edges and at the middles of triangles, evenly chosen.
struct QualityBalls {
  std::vector<Sphere> all;              // those at vertices first, then those of edges
  std::size_t vertices = 0, edges = 0;  // the numbers of balls at vertices and at edges

  std::span<const Sphere> at_vertices() const { return std::span(all).first(vertices); }
};
QualityBalls quality_balls(const MedialMesh& mesh, Index max);

// protruding_balls.cpp
// How deep in the solid a ball's centre is.
struct BallDepth {
  double signed_distance = 0;  // negative inside
  ClosestPoint nearest;        // of the surface
  bool outside() const { return signed_distance > 0; }
  // Whether the centre is outside by more than rounding. A centre on a sharp edge may be on either side.
  bool outside_by(double negligible) const { return signed_distance > negligible; }
};
BallDepth depth_of(const Surface& surface, const Sphere& ball);
std::vector<BallDepth> depths_of(const Surface& surface, std::span<const Sphere> balls);
// How far a ball reaches outside the solid, and where. This is at most the sum of its radius and the signed distance of
// its centre.
struct BallReach {
  double beyond = 0;
  Point farthest = Point::Zero();
};
BallReach reach_of(const Surface& surface, const Sphere& ball, const BallDepth& depth);
// Returns the `count` worst of the places `known` and of the places where these balls protrude by more than
// `negligible` (see worst_of()). It is fast because it examines the far sides of few balls.
std::vector<WorstPlace> worst_protrusions(const Surface& surface, std::span<const Sphere> balls,
                                          std::span<const BallDepth> depths, std::vector<WorstPlace> known, Index count,
                                          double apart, double negligible);

Spread spread_of(std::span<const double> values);

// quality_reconstruction.cpp
// How the boundary of the reconstruction lies to a point of the surface; lengths in mesh units.
struct SurfaceReach {
  double distance = 0;         // from the point to the reconstruction; inside, minus the depth
  double uncovered = 0;        // distance to the reconstruction, 0 inside it
  double beyond = 0;           // how far outside the solid the reconstruction reaches along the normal
  double to_boundary = 0;      // from the point to the reconstruction's boundary; an upper bound if the point is inside
  double min_to_boundary = 0;  // a lower bound on the same: the depth in the deepest ball
  bool arrived = true;         // whether `farthest` is a place of the boundary, or the point itself
  double from_boundary = 0;    // from the surface to a point of the boundary at or near `farthest`
  Point farthest = Point::Zero();    // where the reconstruction ends along the normal
  Sphere ball = {Point::Zero(), 0};  // the last ball on the way to `farthest`
};
// It is fastest if successive samples are near each other on the surface.
std::vector<SurfaceReach> reach_of(const Surface& surface, const Reconstruction& reconstruction,
                                   std::span<const SurfaceSample> samples, double diagonal);
void measure_reconstruction(const Surface& surface, const MedialMesh& mesh, std::span<const SurfaceSample> samples,
                            const QualityBalls& balls, std::span<const BallDepth> depths, const QualityOptions& options,
                            MedialQuality& quality);
// quality_coverage.cpp
// The largest distance of the surface from the reconstruction; `known`: what samples found.
MaxOverTriangles max_coverage(const Surface& surface, const Reconstruction& reconstruction, MaxOverTriangles known,
                              double diagonal);
// Returns the spread of the samples' distances, with 0 for samples whose nearest ball is at the border of a sheet.
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
// Returns the distance from `center` to the part of the surface that is seen at `angle` or more from `direction`
// (unit), to one in a thousand; infinity if there is no such part. It is fastest if the distance is `likely` or
// slightly less.
double second_contact_distance(const Surface& surface, const Point& center, const Vector& direction, double angle,
                               double likely);
// quality_economy.cpp
Economy measure_economy(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options, double diagonal);

}  // namespace orchard::detail
