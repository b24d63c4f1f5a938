#include "fit_samples.h"

#include <algorithm>
#include <cmath>

#include "../quality/quality_parts.h"
#include "orchard/geometry/angle.h"

namespace orchard::detail {
namespace {

// Radians between the normals of a corner and of its triangles: above this, the corner is not flat.
constexpr double kPointed = 0.35;
constexpr double kSharp = 0.5;  // radians between the normals at an edge

struct Pointed {
  double angle = 0;
  FitSample sample;
};

Feature vertex_feature(std::size_t corner) {
  return static_cast<Feature>(static_cast<std::size_t>(Feature::vertex0) + corner);
}

// Returns the corners of the mesh that are not flat, the most pointed ones first.
std::vector<Pointed> pointed_corners(const Surface& surface) {
  std::vector<Pointed> corners;
  const auto& mesh = surface.mesh();
  for (Index v = 0; v < mesh.vertices.size(); ++v) {
    const auto around = surface.triangles_around(v);
    if (around.empty()) continue;
    const auto& first = mesh.triangles[around[0]];
    const auto corner = static_cast<std::size_t>(std::find(first.begin(), first.end(), v) - first.begin());
    const Vector normal = surface.pseudonormal(around[0], vertex_feature(corner));
    double angle = 0;
    for (const Index t : around) {
      if (surface.normal(t).squaredNorm() > 0) angle = std::max(angle, angle_between(normal, surface.normal(t)));
    }
    if (angle > kPointed) corners.push_back({angle, {mesh.vertices[v], normal, 0}});
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Pointed& a, const Pointed& b) { return a.angle > b.angle; });
  return corners;
}

// Adds samples along each sharp edge, about `spacing` apart.
void add_edges(const Surface& surface, double spacing, std::vector<FitSample>& out) {
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto corners = surface.corners(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = surface.neighbors(t)[i];
      if (other == kNone || other < t) continue;
      const Vector normal = surface.normal(t) + surface.normal(other);
      if (!(normal.norm() > 0) || angle_between(surface.normal(t), surface.normal(other)) < kSharp) continue;
      const Point &a = corners[i], &b = corners[(i + 1) % 3];
      const int parts = static_cast<int>(std::min((b - a).norm() / spacing, 1e6)) + 1;
      for (int k = 0; k < parts; ++k) out.push_back({a + (k + 0.5) / parts * (b - a), normal.normalized(), 0});
    }
  }
}

// Keeps at most `max` samples, at even steps.
void thin_out(std::vector<FitSample>& samples, std::size_t max) {
  if (samples.size() <= max) return;
  for (std::size_t i = 0; i < max; ++i) samples[i] = samples[i * samples.size() / max];
  samples.resize(max);
}

}  // namespace

std::vector<FitSample> fit_samples(const Surface& surface, Index count, std::uint64_t seed) {
  std::vector<FitSample> samples;
  for (const SurfaceSample& sample : quality_samples(surface, count, seed))
    samples.push_back({.position = sample.position, .normal = sample.normal, .area = 1.0 / count});
  std::vector<Pointed> corners = pointed_corners(surface);
  if (corners.size() > count / 4) corners.resize(count / 4);
  for (const Pointed& corner : corners) samples.push_back(corner.sample);
  std::vector<FitSample> edges;
  add_edges(surface, 2 * std::sqrt(surface.report().area / count), edges);
  thin_out(edges, count / 4);
  samples.insert(samples.end(), edges.begin(), edges.end());
  for (FitSample& sample : samples) sample.weight = 1.0 / count;
  return samples;
}

}  // namespace orchard::detail
