#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "ball_fit.h"
#include "ball_places.h"
#include "path_regions.h"

namespace orchard::detail {

struct LevelBall : FittedBall {
  Index path_region = kNone;   // the path region of which the ball covers a part
  std::vector<Index> samples;  // inside the ball and its path region, ascending
  // Identifies the samples to which the ball was last tightened, if nothing has changed since then.
  std::uint64_t fitted_to = 0;
};

// The balls of a level as they are now, with the tables that the search and the closing need at every step: which
// samples each ball contains, how many balls contain each sample, and how many balls lie in each path region. Balls
// keep their numbers. Const functions may run in parallel.
class LevelBalls {
 public:
  // Finds the samples of the balls. `max_children` is the limit for balls in a path region, and `measure` is what the
  // balls are fitted by.
  LevelBalls(PathRegions regions, std::vector<LevelBall> balls, Index max_children,
             BallMeasure measure = BallMeasure::reach);

  const PathRegions& regions() const { return regions_; }
  const std::vector<LevelBall>& all() const { return balls_; }
  const LevelBall& operator[](Index ball) const { return balls_[ball]; }
  const BallPlaces& places() const { return places_; }
  BallMeasure measure() const { return measure_; }
  Index size() const { return static_cast<Index>(balls_.size()); }

  void find_samples(LevelBall& ball) const;
  // Returns the samples that only these balls contain, ascending.
  std::vector<Index> held_only_by(std::span<const Index> balls) const;
  // Appends the samples that only this ball contains. Returns a number that identifies them.
  std::uint64_t append_held_alone(Index ball, std::vector<Point>& points) const;
  // The balls' numbers, the loosest first.
  std::vector<Index> loosest_first() const;
  // Moves balls from `order` to the result, beginning with the first, such that no two of them have a sample in common.
  std::vector<Index> take_apart(std::vector<Index>& order) const;

  // Returns the ball fitted to something else, in its path region, with its samples.
  LevelBall fitted(Index ball, const FittedBall& to) const;
  // Replaces a ball by the result of fitted().
  void replace(Index ball, LevelBall by);
  void set_fitted_to(Index ball, std::uint64_t samples) { balls_[ball].fitted_to = samples; }
  // Replaces some balls by others whose samples are known, and leaves the old ones in `by`. Does nothing and returns
  // false if a sample would be lost or a path region would get too many balls.
  bool try_replace(std::span<const Index> balls, std::vector<LevelBall>& by);
  void set_radii(std::span<const double> radii);
  // Adds samples, which are assigned to the balls that contain them.
  void add_samples(const Samples& more);

 private:
  void append_samples(LevelBall& ball, Index first) const;
  void recount();
  void place(Index ball) { places_.set(ball, balls_[ball]); }

  PathRegions regions_;
  std::vector<LevelBall> balls_;
  BallPlaces places_;
  Index max_children_;
  BallMeasure measure_;
  std::vector<Index> holders_;   // of each sample: the number of balls that contain it
  std::vector<Index> children_;  // of each path region: the number of balls in it
};

}  // namespace orchard::detail
