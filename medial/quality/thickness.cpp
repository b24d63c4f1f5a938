#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "ball_tree.h"
#include "orchard/medial/quality.h"

namespace orchard {
namespace {

constexpr double kTouchingBall = 1e-3;     // of the bounding radius: a ball this near to a place counts as touching it
constexpr std::size_t kVertexBlock = 256;  // vertices that one task takes, one after the other

}  // namespace

std::vector<double> medial_radii_at_surface(const Surface& surface, const MedialMesh& mesh) {
  std::vector<Box> boxes;
  for (const Point& center : mesh.centers) boxes.emplace_back(center);
  const detail::BallTree tree(std::move(boxes), mesh.radii);
  const auto& vertices = surface.mesh().vertices;
  std::vector<double> result(vertices.size(), 0);
  tbb::parallel_for(std::size_t{0}, (vertices.size() + kVertexBlock - 1) / kVertexBlock, [&](std::size_t block) {
    // The balls of the previous vertex, which is often near, bound the search.
    Index nearest_ball = kNone, largest_ball = kNone;
    const std::size_t end = std::min(vertices.size(), (block + 1) * kVertexBlock);
    for (std::size_t i = block * kVertexBlock; i < end; ++i) {
      const auto distance = [&](Index ball) { return (vertices[i] - mesh.centers[ball]).norm() - mesh.radii[ball]; };
      double nearest = nearest_ball == kNone ? std::numeric_limits<double>::infinity() : distance(nearest_ball);
      double best = nearest;
      const auto value = [&](Index ball) {
        const double found = distance(ball);
        if (found < best) best = found, nearest_ball = ball;
        return found;
      };
      nearest = tree.min(vertices[i], nearest, value, 1, 0);
      const double touching = std::max(nearest, 0.0) + kTouchingBall * surface.bounding_radius();
      const auto accept = [&](Index ball) {
        if (!(distance(ball) <= touching)) return false;
        largest_ball = ball;
        return true;
      };
      const double known = largest_ball != kNone && accept(largest_ball) ? mesh.radii[largest_ball] : 0;
      result[i] = tree.max_radius(vertices[i], touching, known, accept);
    }
  });
  return result;
}

}  // namespace orchard
