#include "level_start.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "infinity.h"
#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

constexpr int kLloydRounds = 8;  // rounds of Lloyd's iteration
constexpr int kStartEvaluations = 8;

// Finds the largest of several numbers that never increase, and the first one if several are equal. It is a heap of
// earlier values.
class LargestFirst {
 public:
  explicit LargestFirst(const std::vector<double>& now) : now_(now) {
    for (Index i = 0; i < now.size(); ++i) heap_.push_back({now[i], i});
    std::make_heap(heap_.begin(), heap_.end(), after);
  }

  Index largest() {
    while (heap_.front().value != now_[heap_.front().index]) {
      std::pop_heap(heap_.begin(), heap_.end(), after);
      heap_.back().value = now_[heap_.back().index];
      std::push_heap(heap_.begin(), heap_.end(), after);
    }
    return heap_.front().index;
  }

 private:
  struct Entry {
    double value;  // the value when the entry was last compared
    Index index;
  };
  static bool after(const Entry& one, const Entry& other) {
    return one.value < other.value || (one.value == other.value && one.index > other.index);
  }

  const std::vector<double>& now_;
  std::vector<Entry> heap_;
};

// Whether a ball with this distance of its centre becomes less loose than `least` by containing a point at this squared
// distance.
bool is_below(double least, double squared, double center_distance) {
  const double room = least - center_distance;
  return room > 0 && squared < room * room;
}

// During this search, the samples of a ball are those that it owns, and every sample has one owner. A radius below 0
// marks a ball that owns none.
class LevelStart {
 public:
  LevelStart(const Surface& surface, const PathRegions& regions, const LevelOptions& options)
      : surface_(surface),
        regions_(regions),
        samples_(regions.samples()),
        options_(options),
        children_(regions.size(), 0) {}

  std::vector<LevelBall> run() {
    if (samples_.size() == 0) return {};
    seed();
    return relaxed();
  }

  std::vector<LevelBall> run_from(std::vector<LevelBall> balls) {
    balls_ = std::move(balls);
    for (LevelBall& ball : balls_) {
      ball.samples.clear();
      ++children_[ball.path_region];
    }
    return relaxed();
  }

 private:
  std::vector<LevelBall> relaxed() {
    for (int round = 0; round < kLloydRounds; ++round) lloyd_round();
    std::erase_if(balls_, [](const LevelBall& ball) { return ball.samples.empty(); });
    for (LevelBall& ball : balls_) ball.samples.clear();
    return std::move(balls_);
  }

  void seed() {
    const BallFitter fitter(surface_, options_.measure);
    std::vector<double> min(samples_.size(), kInfinity);
    LargestFirst by_min(min);
    Index next = static_cast<Index>(Random(options_.seed, 100 + options_.level).below(samples_.size()));
    for (Index seeds = 0; seeds < samples_.size() && balls_.size() < options_.balls; ++seeds) {
      LevelBall ball;
      static_cast<FittedBall&>(ball) = fitter.at(samples_.starts[next]);
      ball.path_region = region_for_seed(ball, next);
      if (ball.path_region != kNone) {
        const std::vector<Index>& samples = regions_.samples_in(ball.path_region);
        regions_.places_in(ball.path_region).each_squared_distance(ball.center, [&](std::size_t k, double squared) {
          double& least = min[samples[k]];
          if (is_below(least, squared, ball.center_distance)) least = std::sqrt(squared) + ball.center_distance;
        });
        ++children_[ball.path_region];
        balls_.push_back(ball);
      }
      min[next] = -kInfinity;
      next = by_min.largest();
    }
  }

  // Returns the path region with room that contains most of the samples near a place; kNone if all are full.
  Index region_for_seed(const FittedBall& seed, Index sample) const {
    const double near = 1.2 * (samples_.points[sample] - seed.center).norm();
    Index best = kNone, max = 0;
    for (Index r : regions_.regions_of(sample)) {
      if (children_[r] >= options_.max_children) continue;
      Index held = 0;
      for (Index s : regions_.samples_in(r)) held += (samples_.points[s] - seed.center).squaredNorm() <= near * near;
      if (best == kNone || held > max) best = r, max = held;
    }
    return best;
  }

  void lloyd_round() {
    move_unused();
    assign(owners());
    tbb::enumerable_thread_specific<BallFitter> fitters([&] { return BallFitter(surface_, options_.measure); });
    tbb::parallel_for(std::size_t{0}, balls_.size(), [&](std::size_t b) {
      LevelBall& ball = balls_[b];
      ball.radius = -1;
      if (ball.samples.empty()) return;
      std::vector<Point> points;
      for (Index s : ball.samples) points.push_back(samples_.points[s]);
      static_cast<FittedBall&>(ball) = fitters.local().fit(points, ball, kStartEvaluations);
    });
  }

  // Moves each unused ball to share the samples of one of the loosest balls.
  void move_unused() {
    std::vector<Index> unused, used;
    for (Index b = 0; b < balls_.size(); ++b) {
      const bool is_unused = balls_[b].samples.empty() && balls_[b].radius < 0;
      (is_unused ? unused : used).push_back(b);
    }
    const std::size_t count = std::min(unused.size(), used.size());
    std::partial_sort(used.begin(), used.begin() + static_cast<std::ptrdiff_t>(count), used.end(),
                      [&](Index a, Index b) {
                        const double of_a = balls_[a].looseness(), of_b = balls_[b].looseness();
                        return of_a > of_b || (of_a == of_b && a < b);
                      });
    for (std::size_t k = 0; k < count; ++k) share(balls_[used[k]], balls_[unused[k]]);
  }

  void share(const LevelBall& loosest, LevelBall& unused) {
    if (loosest.samples.empty() || children_[loosest.path_region] >= options_.max_children) return;
    const Index far = *std::max_element(loosest.samples.begin(), loosest.samples.end(), [&](Index a, Index b) {
      return (samples_.points[a] - loosest.center).squaredNorm() < (samples_.points[b] - loosest.center).squaredNorm();
    });
    --children_[unused.path_region];
    ++children_[loosest.path_region];
    unused.path_region = loosest.path_region;
    static_cast<FittedBall&>(unused) = BallFitter(surface_, options_.measure).at(samples_.starts[far]);
    unused.radius = -1;
  }

  // Returns for each sample the ball that becomes least loose by it; kNone if no ball lies in a path region of the
  // sample.
  std::vector<Index> owners() const {
    struct RegionBalls {
      std::vector<Index> balls;
      Coordinates centers;
      std::vector<double> center_distances;
    };
    std::vector<RegionBalls> balls_in(regions_.size());
    for (Index b = 0; b < balls_.size(); ++b) {
      RegionBalls& in = balls_in[balls_[b].path_region];
      in.balls.push_back(b);
      in.centers.push_back(balls_[b].center);
      in.center_distances.push_back(balls_[b].center_distance);
    }
    std::vector<Index> owner(samples_.size(), kNone);
    tbb::parallel_for(Index{0}, samples_.size(), [&](Index s) {
      double min = kInfinity;
      for (Index r : regions_.regions_of(s)) {
        const RegionBalls& in = balls_in[r];
        in.centers.each_squared_distance(samples_.points[s], [&](std::size_t k, double squared) {
          if (is_below(min, squared, in.center_distances[k]))
            min = std::sqrt(squared) + in.center_distances[k], owner[s] = in.balls[k];
        });
      }
    });
    return owner;
  }

  void assign(const std::vector<Index>& owner) {
    for (LevelBall& ball : balls_) ball.samples.clear();
    for (Index s = 0; s < samples_.size(); ++s)
      if (owner[s] != kNone) balls_[owner[s]].samples.push_back(s);
  }

  const Surface& surface_;
  const PathRegions& regions_;
  const Samples& samples_;
  const LevelOptions& options_;
  std::vector<LevelBall> balls_;
  std::vector<Index> children_;  // of each path region: the number of balls in it
};

}  // namespace

std::vector<LevelBall> seeded_balls(const Surface& surface, const PathRegions& regions, const LevelOptions& options) {
  return LevelStart(surface, regions, options).run();
}

std::vector<LevelBall> relaxed_balls(const Surface& surface, const PathRegions& regions, const LevelOptions& options,
                                     std::vector<LevelBall> balls) {
  return LevelStart(surface, regions, options).run_from(std::move(balls));
}

}  // namespace orchard::detail
