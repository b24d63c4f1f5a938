#pragma once
#include <vector>

#include "ball_fit.h"
#include "level_cover.h"
#include "level_samples.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/random.h"
#include "uncovered_regions.h"

namespace orchard::detail {

struct LevelBall : FittedBall {
  Index region = kNone;        // that the ball answers for a part of
  std::vector<Index> samples;  // inside the ball and its region, ascending
};

// A level's objective is the sum over its balls of t^power (1 + (t / cap)^cap_power) (radius / R)^size_power, where t
// is the looseness as a multiple of `unit`. The cap keeps the largest near the others where the power is low.
struct LevelCost {
  double power = 4;
  double cap = 0, cap_power = 8;  // cap 0: none
  double size_power = 0;
  double unit = 0;  // 0: the mean looseness of the first solution
};

struct LevelOptions {
  Index balls = 8;          // at most
  Index max_children = 16;  // balls in a region at most
  LevelCost cost;
  std::uint64_t seed = 1;
  Index level = 1;  // for the random numbers
};

// The balls of one level of a tree, all at once: each lies in a region, the common part of the balls on a path of the
// levels above, and answers for samples in it. Which region is open, so that the load balances itself.
//  - A sample goes to the ball that gets least loose by it (Lloyd's iteration in the distance |p - c| + sd(c)).
//  - Large-neighbourhood search: a few neighbouring balls give up what only they hold, some start anew, and they share
//    it out again; kept if the objective falls. Trials run in batches, each on the state before the batch, and are
//    applied in order, so the result does not depend on threads.
class LevelSolver {
 public:
  // paths[r]: the balls from the root down whose common part is region r. Samples in no region are left out.
  LevelSolver(const Surface& surface, Samples samples, std::vector<std::vector<Sphere>> paths,
              const LevelOptions& options);

  void start();  // seeds and Lloyd
  void search(Index trials, const Progress& progress = {});
  void tighten();  // each ball, loosest first, shrinks to the samples that it alone holds

  // Each region goes to the ball that it costs least, and its deepest point becomes a sample; with `hold`, points near
  // its corners too.
  void take_in(const std::vector<UncoveredRegion>& regions, bool hold);

  // From here on the balls cover the surface, and go on doing so: `cover` holds the same balls.
  void take_radii(const LevelCover& cover);
  void refit(LevelCover& cover);                 // each ball, loosest first, to what it alone holds
  void polish(LevelCover& cover, Index trials);  // search, where what a trial leaves open is closed before it is judged

  const std::vector<LevelBall>& balls() const { return balls_; }
  double objective() const;
  double unit() const { return options_.cost.unit; }  // of the looseness in the objective

 private:
  struct Trial;
  class TrialCloser;
  bool in_path(Index region, const Point& point) const;
  bool in_region(Index region, Index sample) const;
  double key(const FittedBall& ball, Index sample) const {
    return (samples_.points[sample] - ball.center).norm() + ball.depth;
  }
  double cost(const FittedBall& ball) const;

  Index region_for_seed(const FittedBall& seed, Index sample) const;
  std::vector<Index> owners() const;
  void assign(const std::vector<Index>& owner);
  void lloyd_round();
  void split_loosest(LevelBall& unused);
  void drop_unused();
  void find_members(LevelBall& ball) const;
  void recount();
  void replace(Index ball, const FittedBall& fitted);

  std::vector<Index> choose(Random& random, Index& moved) const;
  std::vector<Index> held_only_by(const std::vector<Index>& chosen) const;
  void reseed(LevelBall& ball, Index sample, Random& random) const;
  bool share_out(Trial& trial, const std::vector<Index>& freed, int rounds, Random& random) const;
  Trial propose(std::uint64_t number, const LevelCover* cover) const;
  bool close_trial(Trial& trial, double before, const LevelCover& cover) const;
  void run_trials(Index trials, LevelCover* cover, const Progress& progress);
  bool near_any(const Trial& trial, const std::vector<Sphere>& changed) const;
  bool apply(Trial& trial);

  struct Taker {
    Index ball = kNone;
    double rise = 0;  // of its cost
  };
  std::vector<double> slopes() const;
  Taker cheapest_taker(std::span<const Point> region, const std::vector<double>& slopes) const;
  void add_sample(const Point& point, const Point& start);

  const Surface& surface_;
  Samples samples_;
  std::vector<std::vector<Sphere>> paths_;
  LevelOptions options_;
  std::vector<std::vector<Index>> regions_;     // samples in each, ascending
  std::vector<std::vector<Index>> regions_of_;  // each sample, ascending
  std::vector<LevelBall> balls_;
  std::vector<Index> holders_;   // how many balls hold each sample
  std::vector<Index> children_;  // of each region
  std::uint64_t trials_ = 0;     // so far
};

}  // namespace orchard::detail
