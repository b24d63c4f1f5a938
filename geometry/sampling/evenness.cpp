#include <algorithm>
#include <cmath>

#include "cell_hash.h"
#include "orchard/geometry/sampling.h"

namespace orchard {
namespace {

// Two points whose normals point away from each other lie on different sides of a thin part.
bool face_the_same_way(const Vector& a, const Vector& b) { return a.dot(b) > -0.3; }

}  // namespace

Evenness evenness(const SurfaceSampling& sampling, const Surface& surface) {
  Evenness result;
  const std::size_t count = sampling.points.size();
  if (count < 2) return result;
  double area = 0;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) area += surface.area(t);
  std::vector<Vector> normals;
  for (std::size_t i = 0; i < count; ++i)
    normals.push_back(surface.pseudonormal(sampling.triangles[i], sampling.features[i]));

  // For points that have no neighbour in the block of cells around them, the search goes on with cells twice as wide.
  std::vector<double> nearest(count, -1);
  double missing = static_cast<double>(count);
  const double diagonal = surface.bounding_box().diagonal().norm();
  for (double width = 2 * std::sqrt(area / static_cast<double>(count)); missing > 0; width *= 2) {
    if (!(width > 0)) width = diagonal;
    detail::CellHash grid(surface.bounding_box().min(), width);
    std::vector<detail::Cell> cells;
    for (const Point& p : sampling.points) cells.push_back(grid.cell_of(p));
    grid.build(cells);
    missing = 0;
    for (Index i = 0; i < count; ++i) {
      if (nearest[i] >= 0) continue;
      double best = width;
      bool found = false;
      grid.visit_block(cells[i], 3, [&](Index j) {
        const double distance = (sampling.points[i] - sampling.points[j]).norm();
        if (j == i || distance > best || !face_the_same_way(normals[i], normals[j])) return;
        best = distance;
        found = true;
      });
      if (found) nearest[i] = best;
      missing += found ? 0 : 1;
    }
    if (width > 2 * diagonal) break;  // alone on its side
  }
  double sum = 0, squares = 0, min = diagonal, found = 0;
  for (const double distance : nearest) {
    if (distance < 0) continue;
    sum += distance, found += 1;
    min = std::min(min, distance);
  }
  if (found == 0 || sum == 0) return result;
  result.mean = sum / found;
  for (const double distance : nearest)
    if (distance >= 0) squares += (distance - result.mean) * (distance - result.mean);
  result.min = min / result.mean;
  result.variation = std::sqrt(squares / found) / result.mean;
  return result;
}

}  // namespace orchard
