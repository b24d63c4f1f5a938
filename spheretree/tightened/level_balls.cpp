#include "level_balls.h"

#include <algorithm>
#include <numeric>

namespace orchard::detail {
namespace {

// The factor on a radius with which the sample that determines the radius is inside in spite of rounding.
constexpr double kInside = 1 + 1e-12;
// The factor on radii with which balls that touch count as meeting in spite of rounding.
constexpr double kMeeting = 1 + 1e-9;
constexpr std::size_t kMostApart = 16;                 // the maximum number of balls that are fitted in parallel
constexpr std::uint64_t kNaming = 0x9e3779b97f4a7c15;  // an odd factor with many bits, for hash values

}  // namespace

LevelBalls::LevelBalls(PathRegions regions, std::vector<LevelBall> balls, Index max_children, BallMeasure measure)
    : regions_(std::move(regions)), balls_(std::move(balls)), max_children_(max_children), measure_(measure) {
  places_.resize(size());
  for (Index b = 0; b < size(); ++b) {
    place(b);
    find_samples(balls_[b]);
  }
  recount();
}

void LevelBalls::find_samples(LevelBall& ball) const {
  ball.samples.clear();
  append_samples(ball, 0);
}

// Appends the samples in the ball with numbers of at least `first`.
void LevelBalls::append_samples(LevelBall& ball, Index first) const {
  regions_.append_samples(ball.path_region, first, ball.center, ball.radius * ball.radius * kInside, ball.samples);
}

void LevelBalls::recount() {
  holders_.assign(regions_.samples().size(), 0);
  children_.assign(regions_.size(), 0);
  for (const LevelBall& ball : balls_) {
    for (Index s : ball.samples) ++holders_[s];
    ++children_[ball.path_region];
  }
}

std::vector<Index> LevelBalls::held_only_by(std::span<const Index> balls) const {
  thread_local std::vector<Index> count;  // how many of these balls contain each sample; all 0 between calls
  count.resize(std::max<std::size_t>(count.size(), regions_.samples().size()), 0);
  for (Index b : balls)
    for (Index s : balls_[b].samples) ++count[s];
  std::vector<Index> only;
  for (Index b : balls) {
    const auto before = static_cast<std::ptrdiff_t>(only.size());
    for (Index s : balls_[b].samples) {
      if (count[s] == holders_[s]) only.push_back(s);
      count[s] = 0;
    }
    std::inplace_merge(only.begin(), only.begin() + before, only.end());
  }
  return only;
}

std::uint64_t LevelBalls::append_held_alone(Index ball, std::vector<Point>& points) const {
  std::uint64_t name = 0;
  for (Index s : balls_[ball].samples) {
    if (holders_[s] != 1) continue;
    points.push_back(regions_.samples().points[s]);
    name = (name ^ (s + std::uint64_t{1})) * kNaming;
  }
  return name;
}

std::vector<Index> LevelBalls::loosest_first() const {
  std::vector<Index> order(balls_.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return balls_[a].looseness() > balls_[b].looseness(); });
  return order;
}

std::vector<Index> LevelBalls::take_apart(std::vector<Index>& order) const {
  std::vector<Index> apart, left;
  for (Index b : order) {
    const auto meets = [&](Index other) {
      const double reach = (balls_[b].radius + balls_[other].radius) * kMeeting;
      return (balls_[b].center - balls_[other].center).squaredNorm() <= reach * reach;
    };
    const bool free = apart.size() < kMostApart && std::none_of(apart.begin(), apart.end(), meets);
    (free ? apart : left).push_back(b);
  }
  order = std::move(left);
  return apart;
}

LevelBall LevelBalls::fitted(Index ball, const FittedBall& to) const {
  LevelBall fitted;
  static_cast<FittedBall&>(fitted) = to;
  fitted.path_region = balls_[ball].path_region;
  find_samples(fitted);
  return fitted;
}

void LevelBalls::replace(Index ball, LevelBall by) {
  for (Index s : balls_[ball].samples) --holders_[s];
  for (Index s : by.samples) ++holders_[s];
  balls_[ball] = std::move(by);
  place(ball);
}

bool LevelBalls::try_replace(std::span<const Index> balls, std::vector<LevelBall>& by) {
  const auto swap_in = [&] {
    for (std::size_t i = 0; i < by.size(); ++i) {
      LevelBall& old = balls_[balls[i]];
      for (Index s : old.samples) --holders_[s];
      for (Index s : by[i].samples) ++holders_[s];
      --children_[old.path_region];
      ++children_[by[i].path_region];
      std::swap(old, by[i]);
      place(balls[i]);
    }
  };
  swap_in();
  bool allowed = true;
  for (const LevelBall& old : by)
    for (Index s : old.samples) allowed = allowed && holders_[s] > 0;
  for (Index b : balls) allowed = allowed && children_[balls_[b].path_region] <= max_children_;
  if (!allowed) swap_in();
  return allowed;
}

void LevelBalls::set_radii(std::span<const double> radii) {
  for (Index b = 0; b < size(); ++b) {
    balls_[b].radius = radii[b];
    place(b);
    balls_[b].fitted_to = 0;
    find_samples(balls_[b]);
  }
  recount();
}

void LevelBalls::add_samples(const Samples& more) {
  const Index old = regions_.samples().size();
  for (Index s = 0; s < more.size(); ++s) regions_.add_sample(more.points[s], more.starts[s]);
  holders_.resize(regions_.samples().size(), 0);
  for (LevelBall& ball : balls_) {
    const std::size_t before = ball.samples.size();
    append_samples(ball, old);
    for (std::size_t i = before; i < ball.samples.size(); ++i) ++holders_[ball.samples[i]];
  }
}

}  // namespace orchard::detail
