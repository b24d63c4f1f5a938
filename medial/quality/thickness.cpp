#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "ball_tree.h"
#include "orchard/medial/quality.h"

namespace orchard {
namespace {

constexpr double kTouching = 1e-3;  // of the bounding radius: a ball this near touches

}  // namespace

std::vector<double> medial_radii_at_surface(const Surface& surface, const MedialMesh& mesh) {
  std::vector<Box> boxes;
  for (const Point& center : mesh.centers) boxes.emplace_back(center);
  const detail::BallTree tree(std::move(boxes), mesh.radii);
  const auto& vertices = surface.mesh().vertices;
  std::vector<double> result(vertices.size(), 0);
  tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t i) {
    const auto distance = [&](Index ball) { return (vertices[i] - mesh.centers[ball]).norm() - mesh.radii[ball]; };
    const double nearest = tree.min(vertices[i], std::numeric_limits<double>::infinity(), distance, 1, 0);
    const double touching = std::max(nearest, 0.0) + kTouching * surface.bounding_radius();
    result[i] = tree.max_radius(vertices[i], touching, 0, [&](Index ball) { return distance(ball) <= touching; });
  });
  return result;
}

}  // namespace orchard
