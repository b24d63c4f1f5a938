#pragma once
#include <span>
#include <vector>

#include "orchard/medial/quality.h"

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
  std::vector<Sphere> vertices, edges, triangles;
};
QualityBalls quality_balls(const MedialMesh& mesh, Index max);

Spread spread_of(std::span<const double> values);

// quality_reconstruction.cpp
void measure_reconstruction(const Surface& surface, const MedialMesh& mesh, std::span<const SurfaceSample> samples,
                            const QualityBalls& balls, MedialQuality& quality);
// quality_contacts.cpp
void measure_contacts(const Surface& surface, const QualityBalls& balls, const QualityOptions& options,
                      MedialQuality& quality);
// The distance from `center` to the part of the surface that is seen at `angle` or more from `direction` (unit), up to
// one in a thousand. `reach`: where to look first.
double second_contact_distance(const Surface& surface, const Point& center, const Vector& direction, double angle,
                               double reach);
// quality_economy.cpp
Economy measure_economy(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options, double diagonal);

}  // namespace orchard::detail
