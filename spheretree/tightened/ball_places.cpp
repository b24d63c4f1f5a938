#include "ball_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wide.h"

namespace orchard::detail {
namespace {

// An upper bound on the relative error of distances, with a large margin.
constexpr double kPlaceRounding = 1e-9;

}  // namespace

void BallPlaces::resize(Index count) {
  count_ = count;
  const double nowhere = std::numeric_limits<double>::infinity();
  const Lanes far = {nowhere, nowhere, nowhere, nowhere};
  fours_.assign((count + kLanes - 1) / kLanes, Four{far, far, far, {}});
}

void BallPlaces::set(Index ball, const FittedBall& now) {
  Four& four = fours_[ball / kLanes];
  const std::size_t lane = ball % kLanes;
  four.x[lane] = now.center.x();
  four.y[lane] = now.center.y();
  four.z[lane] = now.center.z();
  four.half_radius[lane] = 0.5 * now.radius;
}

// Skips everything that is farther than `spread` times the farthest of the `count` nearest so far.
inline void BallPlaces::gather(const Query& query) const {
  const Four& own = fours_[query.of / kLanes];
  const std::size_t lane = query.of % kLanes;
  const double x = own.x[lane], y = own.y[lane], z = own.z[lane];
  std::vector<double> least;  // ascending
  double largest = 0;         // the largest number that they came from
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t block = 0; block < fours_.size(); ++block) {
    const Four& four = fours_[block];
    const Lanes dx = four.x - x, dy = four.y - y, dz = four.z - z;
    const Lanes squared = dx * dx + (dy * dy + dz * dz), reach = limit + four.half_radius;
    const auto in_reach = (squared <= reach * reach * (1 + kPlaceRounding)) & (reach >= 0.0);
    if ((in_reach[0] | in_reach[1] | in_reach[2] | in_reach[3]) == 0) continue;
    for (std::size_t k = 0; k < kLanes; ++k) {
      const auto ball = static_cast<Index>(kLanes * block + k);
      if (in_reach[k] == 0 || ball == query.of || ball >= count_) continue;
      const double distance = std::sqrt(squared[k]), half = four.half_radius[k], apart = distance - half;
      query.near.push_back({apart, ball});
      if (least.size() == query.count && apart >= least.back()) continue;
      if (least.size() == query.count) least.pop_back();
      largest = std::max(largest, distance + half);
      least.insert(std::upper_bound(least.begin(), least.end(), apart), apart);
      if (least.size() < query.count) continue;
      const double last = least.back();
      limit = std::min(limit, (last > 0 ? last * query.spread : last / query.spread) + kPlaceRounding * largest);
    }
  }
  std::erase_if(query.near, [&](const Near& near) { return near.apart > limit; });
}

ORCHARD_FOR_AVX2 void BallPlaces::gather_wide(const Query& query) const { gather(query); }

std::vector<Index> BallPlaces::nearest(Index of, std::size_t count, double least, double most) const {
  std::vector<Index> balls;
  if (count == 0) return balls;
  thread_local std::vector<Near> near;
  near.clear();
  const Query query{of, count, most / least, near};
  wide() ? gather_wide(query) : gather(query);
  for (const auto& [apart, ball] : near) balls.push_back(ball);
  return balls;
}

}  // namespace orchard::detail
