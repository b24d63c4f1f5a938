#include "thinning.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "orchard/geometry/grid_cell.h"

namespace orchard::detail {
namespace {

// In spacings: points nearer than this are crowded; relaxed points keep about 1 apart.
constexpr double kCrowded = 0.75;
constexpr double kSameSide = 0.5;  // cosine of the angle between normals on one side of the surface: 60 degrees
constexpr double kFacing = -kSameSide;

// Returns the points within `reach` of each point, found by a grid with cells of that width.
Rows points_near(const std::vector<Point>& points, double reach) {
  const auto cell_of = [&](const Point& point) { return grid_cell(point - points[0], reach); };
  std::vector<std::pair<GridCell, Index>> sorted;
  for (Index i = 0; i < points.size(); ++i) sorted.emplace_back(cell_of(points[i]), i);
  std::sort(sorted.begin(), sorted.end());
  Rows near;
  for (Index i = 0; i < points.size(); ++i) {
    const GridCell cell = cell_of(points[i]);
    for (std::int64_t x = -1; x <= 1; ++x) {
      for (std::int64_t y = -1; y <= 1; ++y) {
        const GridCell first{cell[0] + x, cell[1] + y, cell[2] - 1}, last{cell[0] + x, cell[1] + y, cell[2] + 1};
        auto other = std::lower_bound(sorted.begin(), sorted.end(), std::pair{first, Index{0}});
        for (; other != sorted.end() && other->first <= last; ++other) {
          const Index k = other->second;
          if (k != i && (points[k] - points[i]).squaredNorm() <= reach * reach) near.items.push_back(k);
        }
      }
    }
    near.close_row();
  }
  return near;
}

class Thinning {
 public:
  Thinning(const Surface& surface, const SurfaceSampling& sampling, double spacing)
      : points_(sampling.points), near_(points_near(points_, spacing)), stays_(points_.size(), 1) {
    for (Index i = 0; i < points_.size(); ++i) {
      normals_.push_back(surface.pseudonormal(sampling.triangles[i], sampling.features[i]));
    }
    for (Index i = 0; i < points_.size(); ++i) across_.push_back(nearest(i, -1, kFacing));
  }

  std::vector<std::uint8_t> run(double crowded) {
    std::vector<std::pair<double, Index>> pairs;
    for (Index i = 0; i < points_.size(); ++i) {
      const Index other = across_[i];
      if (other != kNone && other > i && across_[other] == i) pairs.emplace_back(gap(i), i);
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [distance, i] : pairs) {
      if (gap(i) < crowded && gap(across_[i]) < crowded) stays_[i] = stays_[across_[i]] = 0;
    }
    return std::move(stays_);
  }

 private:
  // Returns the nearest point that stays and whose normal has a cosine between the two limits with the normal of i;
  // kNone if there is none.
  Index nearest(Index i, double min, double max) const {
    Index best = kNone;
    double squared = std::numeric_limits<double>::infinity();
    for (const Index k : near_[i]) {
      const double cosine = normals_[k].dot(normals_[i]);
      const double candidate = (points_[k] - points_[i]).squaredNorm();
      if (!stays_[k] || cosine < min || cosine > max || !(candidate < squared)) continue;
      squared = candidate;
      best = k;
    }
    return best;
  }
  double gap(Index i) const {
    const Index other = nearest(i, kSameSide, 2);
    return other == kNone ? std::numeric_limits<double>::infinity() : (points_[other] - points_[i]).norm();
  }

  const std::vector<Point>& points_;
  const Rows near_;
  std::vector<std::uint8_t> stays_;
  std::vector<Vector> normals_;
  std::vector<Index> across_;
};

}  // namespace

std::vector<std::uint8_t> without_crowded_pairs(const Surface& surface, const SurfaceSampling& sampling,
                                                double spacing) {
  return Thinning(surface, sampling, spacing).run(kCrowded * spacing);
}

SurfaceSampling points_that_stay(const SurfaceSampling& sampling, const std::vector<std::uint8_t>& stay) {
  SurfaceSampling result;
  for (Index i = 0; i < sampling.size(); ++i) {
    if (!stay[i]) continue;
    result.points.push_back(sampling.points[i]);
    result.triangles.push_back(sampling.triangles[i]);
    result.features.push_back(sampling.features[i]);
    result.origins.push_back(sampling.origins[i]);
  }
  return result;
}

}  // namespace orchard::detail
