#include "medial/light_balls.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace orchard::apps {
namespace {

std::vector<Index> largest_of_cells(std::span<const Sphere> balls, const Point& low, double cell) {
  using Cell = std::array<std::int64_t, 3>;
  std::vector<std::pair<Cell, Index>> placed;
  placed.reserve(balls.size());
  for (Index i = 0; i < balls.size(); ++i) {
    const Point place = (balls[i].center - low) / cell;
    placed.push_back({{static_cast<std::int64_t>(place.x()), static_cast<std::int64_t>(place.y()),
                       static_cast<std::int64_t>(place.z())},
                      i});
  }
  std::sort(placed.begin(), placed.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    if (balls[a.second].radius != balls[b.second].radius) return balls[a.second].radius > balls[b.second].radius;
    return a.second < b.second;
  });
  std::vector<Index> kept;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (i == 0 || placed[i].first != placed[i - 1].first) kept.push_back(placed[i].second);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace

std::vector<Index> light_balls(std::span<const Sphere> balls, Index most) {
  std::vector<Index> kept(balls.size());
  std::iota(kept.begin(), kept.end(), Index{0});
  if (balls.size() <= most) return kept;
  Box box;
  for (const Sphere& ball : balls) box.extend(ball.center);
  // Bisects between cells that contain a single ball each and one cell around everything.
  double fine = 0, coarse = 1.0001 * box.sizes().maxCoeff();
  if (coarse == 0) return {largest_of_cells(balls, box.min(), 1).front()};
  kept = largest_of_cells(balls, box.min(), coarse);
  constexpr int kSteps = 40;
  for (int i = 0; i < kSteps && static_cast<double>(kept.size()) < 0.95 * static_cast<double>(most); ++i) {
    const double cell = 0.5 * (fine + coarse);
    std::vector<Index> finer = largest_of_cells(balls, box.min(), cell);
    if (finer.size() <= most) {
      kept = std::move(finer);
      coarse = cell;
    } else {
      fine = cell;
    }
  }
  return kept;
}

}  // namespace orchard::apps
