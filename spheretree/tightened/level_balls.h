#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "ball_fit.h"
#include "ball_places.h"
#include "path_regions.h"

namespace orchard::detail {

struct LevelBall : FittedBall {
  Index path_region = kNone;    // that the ball answers for a part of
  std::vector<Index> samples;   // inside the ball and its path region, ascending
  std::uint64_t fitted_to = 0;  // names the samples that it was last tightened to, if nothing has changed it since
};

// The balls of a level as they are now, with the books that the search and the closing need at every step: which
// samples each ball holds, how many balls hold each sample, how many balls lie in each path region. Balls keep their
// numbers. Const functions may run in parallel.
class LevelBalls {
 public:
  // Finds the samples of the balls. max_children: of balls in a path region. measure: what the balls are fitted by.
  LevelBalls(PathRegions regions, std::vector<LevelBall> balls, Index max_children,
             BallMeasure measure = BallMeasure::reach);

  const PathRegions& regions() const { return regions_; }
  const std::vector<LevelBall>& all() const { return balls_; }
  const LevelBall& operator[](Index ball) const { return balls_[ball]; }
  const BallPlaces& places() const { return places_; }
  BallMeasure measure() const { return measure_; }
  Index size() const { return static_cast<Index>(balls_.size()); }

  void find_samples(LevelBall& ball) const;
  // Samples that only these balls hold, ascending.
  std::vector<Index> held_only_by(std::span<const Index> balls) const;
  // Appends the samples that only this ball holds; returns a number that names them.
  std::uint64_t append_held_alone(Index ball, std::vector<Point>& points) const;
  // The balls' numbers, the loosest first.
  std::vector<Index> loosest_first() const;
  // Moves balls from `order` to the result, from its begin on, no two of which meet: they have no sample in common.
  std::vector<Index> take_apart(std::vector<Index>& order) const;

  // The ball as it would be in its path region, fitted to something else, with its samples.
  LevelBall fitted(Index ball, const FittedBall& to) const;
  // By what fitted() gave.
  void replace(Index ball, LevelBall by);
  void set_fitted_to(Index ball, std::uint64_t samples) { balls_[ball].fitted_to = samples; }
  // Puts other balls, whose samples are known, in the place of some, and leaves these in `by`. Does nothing, and
  // returns false, if a sample would be lost or a path region would get too many balls.
  bool try_replace(std::span<const Index> balls, std::vector<LevelBall>& by);
  void set_radii(std::span<const double> radii);
  // The balls take those of the samples that they hold.
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
  std::vector<Index> holders_;   // how many balls hold each sample
  std::vector<Index> children_;  // how many balls lie in each path region
};

}  // namespace orchard::detail
