#include "uncovered.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "../gaps/point_tree.h"
#include "../quality/max_over_triangles.h"

namespace orchard::detail {
namespace {

constexpr std::size_t kBlock = 64;  // parts that one task looks at

// The distance to one ball is convex, so over a triangle it is nowhere larger than here.
double max_distance_at(const Corners& corners, const Sphere& ball) {
  double value = -ball.radius;
  for (const Point& corner : corners) value = std::max(value, (corner - ball.center).norm() - ball.radius);
  return value;
}

}  // namespace

struct UncoveredSearch::Block {
  std::span<const Corners> parts;
  std::vector<UncoveredPlace> places;
  std::vector<Corners> open;
};

UncoveredSearch::UncoveredSearch(const Surface& surface, double limit, double resolution)
    : surface_(surface), limit_(limit), resolution_(resolution) {
  const TriangleMesh& mesh = surface.mesh();
  std::vector<std::uint8_t> is_used(mesh.vertices.size(), 0);
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    parts_.push_back(surface.corners(t));
    for (const Index v : mesh.triangles[t]) is_used[v] = 1;
  }
  for (Index v = 0; v < mesh.vertices.size(); ++v) {
    if (is_used[v]) parts_.push_back({mesh.vertices[v], mesh.vertices[v], mesh.vertices[v]});
  }
}

void UncoveredSearch::look_at(const Reconstruction& reconstruction, Block& block) const {
  Sphere ball{Point::Zero(), -std::numeric_limits<double>::infinity()};  // the last one found: often near the next part
  std::vector<Corners> parts;
  for (const Corners& given : block.parts) {
    parts.push_back(given);
    while (!parts.empty()) {
      const Corners corners = parts.back();
      parts.pop_back();
      if (max_distance_at(corners, ball) <= limit_) continue;
      const Point middle = (corners[0] + corners[1] + corners[2]) / 3;
      double reach = 0;
      for (const Point& corner : corners) reach = std::max(reach, (corner - middle).norm());
      const double value =
          reconstruction.distance_between(limit_ - reach, std::numeric_limits<double>::infinity(), middle, ball);
      // The distance to all of them is 1-Lipschitz.
      if (value + reach <= limit_ || max_distance_at(corners, ball) <= limit_) continue;
      if (value > limit_) block.places.push_back({value, middle});
      if (reach <= resolution_) {
        block.open.push_back(corners);
        continue;
      }
      const auto [a, b] = halves(corners);
      parts.push_back(a);
      parts.push_back(b);
    }
  }
}

std::vector<UncoveredPlace> UncoveredSearch::find(const Reconstruction& reconstruction, double apart) {
  std::vector<Block> blocks((parts_.size() + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::size_t begin = i * kBlock;
    blocks[i].parts = std::span(parts_).subspan(begin, std::min(kBlock, parts_.size() - begin));
    look_at(reconstruction, blocks[i]);
  });
  std::vector<UncoveredPlace> all;
  std::vector<Corners> open;
  for (const Block& block : blocks) {
    all.insert(all.end(), block.places.begin(), block.places.end());
    open.insert(open.end(), block.open.begin(), block.open.end());
  }
  parts_ = std::move(open);
  // Position decides between equals, so that the result depends on nothing else.
  std::sort(all.begin(), all.end(), [](const UncoveredPlace& a, const UncoveredPlace& b) {
    const auto key = [](const UncoveredPlace& place) {
      return std::tuple(-place.value, place.position.x(), place.position.y(), place.position.z());
    };
    return key(a) < key(b);
  });
  PointTree tree(surface_.bounding_box());
  std::vector<UncoveredPlace> places;
  for (const UncoveredPlace& place : all) {
    const auto is_near = [&](const Point& other) { return (other - place.position).norm() < apart; };
    if (tree.any_within(place.position, apart, is_near)) continue;
    tree.add(place.position);
    places.push_back(place);
  }
  return places;
}

}  // namespace orchard::detail
