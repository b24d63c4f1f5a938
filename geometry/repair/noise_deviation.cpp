#include <tbb/parallel_for.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "half_edges.h"
#include "orchard/geometry/noise.h"
#include "orchard/geometry/tolerance.h"
#include "repair/vertex_rings.h"

namespace orchard {
namespace {

constexpr Index kCubicTerms = 10, kQuadricTerms = 6;
// Vertices of a fit in addition to its terms; with fewer, the residual is not meaningful.
constexpr Index kFewestSpare = 4;

using Fit = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 64, kCubicTerms>;
using Heights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 64, 1>;

constexpr double kDesigned = 0.1;  // share of flat edges above which the mesh is a designed part and no scan

Vector normal_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
}

// Whether the mesh has so many edges between coplanar triangles that it is a designed part.
bool is_designed(const TriangleMesh& mesh) {
  const std::vector<std::array<Index, 3>> neighbors = triangle_neighbors(mesh);
  std::size_t flat = 0, edges = 0;
  for (std::size_t t = 0; t < neighbors.size(); ++t)
    for (const Index other : neighbors[t]) {
      if (other == kNone || other < t) continue;
      const Vector normal = normal_of(mesh, t), across = normal_of(mesh, other);
      ++edges;
      if (normal.cross(across).norm() <= tolerance::kCoplanarAngle * normal.norm() * across.norm() &&
          normal.dot(across) > 0)
        ++flat;
    }
  return static_cast<double>(flat) >= kDesigned * static_cast<double>(edges);
}

Vector area_normal(const TriangleMesh& mesh, const VertexRings& rings, std::span<const Index> vertices) {
  Vector normal = Vector::Zero();
  for (const Index vertex : vertices)
    for (const Index triangle : rings.triangles_at[vertex]) normal += normal_of(mesh, triangle);
  return normal;
}

// Returns the standard deviation of the heights of a ring over the best cubic, or over the best quadric if there are
// few vertices. It is NaN if there are not enough vertices, or if they are not a graph over a plane.
double deviation(const TriangleMesh& mesh, const VertexRings& rings, Index vertex) {
  constexpr double kUnknownDeviation = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Index> around = rings.two_rings(vertex, 64);
  const auto count = static_cast<Index>(around.size());
  if (count < kQuadricTerms + kFewestSpare) return kUnknownDeviation;
  const Index terms = count >= kCubicTerms + kFewestSpare ? kCubicTerms : kQuadricTerms;
  const Vector normal = area_normal(mesh, rings, around).normalized();
  if (!normal.allFinite()) return kUnknownDeviation;
  const Vector u = normal.unitOrthogonal(), v = normal.cross(u);
  double size = 0;
  for (const Index other : around) size = std::max(size, (mesh.vertices[other] - mesh.vertices[vertex]).norm());
  if (!(size > 0)) return kUnknownDeviation;
  Fit fit(count, terms);
  Heights heights(count);
  for (Index row = 0; row < count; ++row) {
    const Vector offset = (mesh.vertices[around[row]] - mesh.vertices[vertex]) / size;
    const double x = offset.dot(u), y = offset.dot(v);
    const double powers[kCubicTerms] = {1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
    for (Index term = 0; term < terms; ++term) fit(row, term) = powers[term];
    heights[row] = offset.dot(normal);
  }
  const Heights solved = fit.colPivHouseholderQr().solve(heights);
  return size * std::sqrt((heights - fit * solved).squaredNorm() / static_cast<double>(count - terms));
}

}  // namespace

double noise_deviation(const TriangleMesh& mesh) {
  if (is_designed(mesh)) return 0;
  const VertexRings rings(mesh);
  const std::size_t count = mesh.vertices.size();
  std::vector<double> deviations(count);
  tbb::parallel_for(std::size_t{0}, count,
                    [&](std::size_t i) { deviations[i] = deviation(mesh, rings, static_cast<Index>(i)); });
  std::erase_if(deviations, [](double value) { return std::isnan(value); });
  if (deviations.empty() || 2 * deviations.size() < count) return 0;
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return *middle / diagonal_of(mesh);
}

}  // namespace orchard
