#include "uncovered.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "../gaps/point_tree.h"
#include "../quality/max_over_triangles.h"
#include "recent_cells.h"

namespace orchard::detail {
namespace {

constexpr std::size_t kPartBlock = 64;  // parts that one task looks at
constexpr double kEnoughReach =
    0.5;  // of the limit, or depth: nearer cells are no better at covering parts that reach farther

bool lexicographically_before(const Point& a, const Point& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

// The corners of the parts, each once, as parts that are single points.
std::vector<Corners> corners_of(const std::vector<Corners>& parts) {
  std::vector<Point> points;
  for (const Corners& part : parts) points.insert(points.end(), part.begin(), part.end());
  std::sort(points.begin(), points.end(), lexicographically_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Corners> corners;
  corners.reserve(points.size());
  for (const Point& point : points) corners.push_back({point, point, point});
  return corners;
}

std::vector<Corners> all_corners(const Surface& surface) {
  std::vector<Corners> corners;
  const auto triangles = static_cast<Index>(surface.mesh().triangles.size());
  corners.reserve(triangles);
  for (Index t = 0; t < triangles; ++t) corners.push_back(surface.corners(t));
  return corners;
}

}  // namespace

struct UncoveredSearch::Block {
  std::span<const Corners> parts;
  std::vector<UncoveredPlace> places;
  std::vector<Corners> open,
      not_covered;  // smaller parts of `parts` that may be open; the parts of `parts` that they belong to
};

UncoveredSearch::UncoveredSearch(const Surface& surface, std::vector<Corners> parts, double depth, double resolution)
    : surface_(surface),
      limit_(0),
      resolution_(resolution),
      detail_(resolution),
      depth_(depth),
      given_(std::move(parts)),
      parts_(given_) {}

UncoveredSearch::UncoveredSearch(const Surface& surface, double limit, double resolution, double detail)
    : surface_(surface),
      limit_(limit),
      resolution_(resolution),
      detail_(std::min(detail, resolution)),
      depth_(0),
      given_(all_corners(surface)),
      parts_(given_) {}

// How near a cell has to be to a place so that it is likely to cover a part that reaches `reach` from there.
double UncoveredSearch::enough(double reach) const {
  if (depth_ > 0) return -std::min(reach, kEnoughReach * depth_);
  return reach < limit_ ? limit_ - reach : kEnoughReach * limit_;
}

void UncoveredSearch::look_at(const Reconstruction& reconstruction, Block& block) const {
  RecentCells recent(reconstruction);
  std::vector<Corners> parts;
  for (const Corners& given : block.parts) {
    const std::size_t open_before = block.open.size();
    parts.push_back(given);
    while (!parts.empty()) {
      const Corners corners = parts.back();
      parts.pop_back();
      if (recent.cover(corners, limit_)) continue;
      const Point middle = (corners[0] + corners[1] + corners[2]) / 3;
      double reach = 0;
      for (const Point& corner : corners) reach = std::max(reach, (corner - middle).norm());
      const double enough = this->enough(reach);
      Reconstruction::Nearest nearest = recent.nearest(middle, enough);
      if (!(nearest.distance < enough)) nearest = reconstruction.nearest_from(nearest, middle, enough);
      if (nearest.cell != kNone) recent.add(nearest.cell);
      const double value = nearest.distance;
      // The distance from the reconstruction is 1-Lipschitz.
      if (value + reach <= limit_ || recent.cover(corners, limit_)) continue;
      if (reach < kEnoughReach * depth_ && surface_.distance(middle) + reach < depth_) continue;
      if (value > limit_) block.places.push_back({value, middle, middle});
      if (reach <= (value > limit_ ? resolution_ : detail_)) {
        block.open.push_back(corners);
        continue;
      }
      const auto [a, b] = halves(corners);
      parts.push_back(a);
      parts.push_back(b);
    }
    if (block.open.size() > open_before) block.not_covered.push_back(given);
  }
}

UncoveredSearch::Block UncoveredSearch::look_at_all(const Reconstruction& reconstruction,
                                                    const std::vector<Corners>& parts) const {
  std::vector<Block> blocks((parts.size() + kPartBlock - 1) / kPartBlock);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const std::size_t begin = i * kPartBlock;
    blocks[i].parts = std::span(parts).subspan(begin, std::min(kPartBlock, parts.size() - begin));
    look_at(reconstruction, blocks[i]);
  });
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  Block all{.parts = parts, .places = {}, .open = {}, .not_covered = {}};
  for (const Block& block : blocks) {
    append(all.places, block.places);
    append(all.open, block.open);
    append(all.not_covered, block.not_covered);
  }
  return all;
}

std::vector<UncoveredPlace> UncoveredSearch::find(const Reconstruction& reconstruction, double apart) {
  Block found = look_at_all(reconstruction, parts_);
  std::vector<UncoveredPlace> all = std::move(found.places);
  if (with_corners_) {
    // Only the middles of the smallest parts were tested. The farthest places are often corners, so these are tested,
    // too.
    const Block corners = look_at_all(reconstruction, corners_of(found.not_covered));
    all.insert(all.end(), corners.places.begin(), corners.places.end());
    found.open.insert(found.open.end(), corners.open.begin(), corners.open.end());
    with_corners_ = false;
  }
  parts_ = std::move(found.open);
  return worst_apart(std::move(all), apart, surface_.bounding_box());
}

void UncoveredSearch::look_again(std::span<const Sphere> spheres) {
  for (const Corners& part : given_) {
    Box box;
    for (const Point& corner : part) box.extend(corner);
    const auto touches = [&](const Sphere& sphere) {
      const double reach = sphere.radius + limit_;
      return box.squaredExteriorDistance(sphere.center) <= reach * reach;
    };
    if (std::any_of(spheres.begin(), spheres.end(), touches)) parts_.push_back(part);
  }
  with_corners_ = true;
}

std::vector<UncoveredPlace> worst_apart(std::vector<UncoveredPlace> all, double apart, const Box& box) {
  std::sort(all.begin(), all.end(), [](const UncoveredPlace& a, const UncoveredPlace& b) {
    const auto key = [](const UncoveredPlace& place) {
      return std::tuple(-place.value, place.position.x(), place.position.y(), place.position.z());
    };
    return key(a) < key(b);
  });
  PointTree tree(box);
  std::vector<UncoveredPlace> places;
  for (const UncoveredPlace& place : all) {
    const auto is_near = [&](const Point& other) { return (other - place.inside).norm() < apart; };
    if (tree.any_within(place.inside, apart, is_near)) continue;
    tree.add(place.inside);
    places.push_back(place);
  }
  return places;
}

}  // namespace orchard::detail
