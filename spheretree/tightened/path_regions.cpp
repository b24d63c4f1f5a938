#include "path_regions.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace orchard::detail {
namespace {

// In radii: a point that is farther than this from the centre of a path's last ball is not in it, whatever the
// rounding.
constexpr double kInQuestion = 1 + 1e-9;
// The side of a grid's cells, in mean radii of the balls. It is such that few balls have to be tested for a point.
constexpr double kCellSide = 1;
constexpr double kMostCells = 64;  // along the grid's longest side

}  // namespace

PathRegions::PathRegions(const Samples& samples, std::vector<std::vector<Sphere>> paths)
    : paths_(std::move(paths)), samples_in_(paths_.size()), places_in_(paths_.size()) {
  make_grid();
  std::vector<std::vector<Index>> regions(samples.size());
  tbb::parallel_for(Index{0}, samples.size(), [&](Index s) { regions[s] = regions_around(samples.points[s]); });
  for (Index s = 0; s < samples.size(); ++s)
    if (!regions[s].empty()) append(samples.points[s], samples.starts[s], std::move(regions[s]));
}

void PathRegions::append_samples(Index path_region, Index first, const Point& center, double squared_radius,
                                 std::vector<Index>& samples) const {
  const std::vector<Index>& all = samples_in_[path_region];
  const Coordinates& at = places_in_[path_region];
  double squared[Coordinates::kBlock];
  Index within[Coordinates::kBlock];
  auto begin = static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), first) - all.begin());
  while (begin < all.size()) {
    const std::size_t measured = at.measure_block(begin, center, squared);
    std::size_t count = 0;
    for (std::size_t k = 0; k < measured; ++k) {  // without a branch: a sample that is too far is overwritten
      within[count] = all[begin + k];
      count += static_cast<std::size_t>(squared[k] <= squared_radius);
    }
    samples.insert(samples.end(), within, within + count);
    begin += measured;
  }
}

bool PathRegions::holds(Index path_region, const Point& point) const {
  const std::vector<Sphere>& path = paths_[path_region];  // the smallest ball, which rules out most points, comes last
  return std::all_of(path.rbegin(), path.rend(), [&](const Sphere& ball) {
    return (point - ball.center).squaredNorm() <= ball.radius * ball.radius;
  });
}

bool PathRegions::holds_sample(Index path_region, Index sample) const {
  const std::vector<Index>& regions = regions_of_[sample];
  return std::find(regions.begin(), regions.end(), path_region) != regions.end();
}

void PathRegions::add_sample(const Point& point, const Point& start) { append(point, start, regions_around(point)); }

void PathRegions::make_grid() {
  if (size() == 0) return near_.resize(1);
  Box box;
  double mean_radius = 0;
  for (const auto& path : paths_) {
    const Sphere& ball = path.back();
    box.extend(ball.center);
    mean_radius += ball.radius / size();
  }
  corner_ = box.min() - Vector::Constant(mean_radius);
  const Vector sides = box.sizes() + Vector::Constant(2 * mean_radius);
  cell_side_ = std::max(kCellSide * mean_radius, sides.maxCoeff() / kMostCells);
  for (std::size_t k = 0; k < 3; ++k) cells_[k] = static_cast<Index>(sides[static_cast<int>(k)] / cell_side_) + 1;
  near_.resize(std::size_t{cells_[0]} * cells_[1] * cells_[2]);
  for (Index r = 0; r < size(); ++r) {
    const Sphere& ball = paths_[r].back();
    const Vector reach = Vector::Constant(ball.radius * kInQuestion);
    const Cell first = cell_at(ball.center - reach), last = cell_at(ball.center + reach);
    Cell cell;
    for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2])
      for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1])
        for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) near_[place_of(cell)].push_back(r);
  }
}

PathRegions::Cell PathRegions::cell_at(const Point& point) const {
  Cell cell;
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    const double at = (point[axis] - corner_[axis]) / cell_side_;
    cell[k] = static_cast<Index>(std::clamp(at, 0.0, cells_[k] - 1.0));
  }
  return cell;
}

std::vector<Index> PathRegions::regions_around(const Point& point) const {
  std::vector<Index> regions;
  for (Index r : near_[place_of(cell_at(point))])
    if (holds(r, point)) regions.push_back(r);
  return regions;
}

void PathRegions::append(const Point& point, const Point& start, std::vector<Index> regions) {
  for (Index r : regions) {
    samples_in_[r].push_back(samples_.size());
    places_in_[r].push_back(point);
  }
  samples_.points.push_back(point);
  samples_.starts.push_back(start);
  regions_of_.push_back(std::move(regions));
}

}  // namespace orchard::detail
