#include "path_regions.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace orchard::detail {
namespace {

// A point this far outside a path's last ball, in squares of its radius, is not in it, whatever the rounding.
constexpr double kInQuestion = 1 + 1e-9;

}  // namespace

PathRegions::PathRegions(const Samples& samples, std::vector<std::vector<Sphere>> paths)
    : paths_(std::move(paths)), samples_in_(paths_.size()) {
  for (auto* numbers : {&x_, &y_, &z_, &limits_}) numbers->resize(size());
  for (Index r = 0; r < size(); ++r) {
    const Sphere& last = paths_[r].back();
    x_[r] = last.center.x(), y_[r] = last.center.y(), z_[r] = last.center.z();
    limits_[r] = last.radius * last.radius * kInQuestion;
  }
  std::vector<std::vector<Index>> regions(samples.size());
  tbb::parallel_for(Index{0}, samples.size(), [&](Index s) { regions[s] = regions_around(samples.points[s]); });
  for (Index s = 0; s < samples.size(); ++s)
    if (!regions[s].empty()) append(samples.points[s], samples.starts[s], std::move(regions[s]));
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

std::vector<Index> PathRegions::regions_around(const Point& point) const {
  std::vector<Index> regions;
  thread_local Eigen::ArrayXd beyond;
  beyond = (x_ - point.x()).square() + (y_ - point.y()).square() + (z_ - point.z()).square() - limits_;
  for (Index r = 0; r < size(); ++r)
    if (beyond[r] <= 0 && holds(r, point)) regions.push_back(r);
  return regions;
}

void PathRegions::append(const Point& point, const Point& start, std::vector<Index> regions) {
  for (Index r : regions) samples_in_[r].push_back(samples_.size());
  samples_.points.push_back(point);
  samples_.starts.push_back(start);
  regions_of_.push_back(std::move(regions));
}

}  // namespace orchard::detail
