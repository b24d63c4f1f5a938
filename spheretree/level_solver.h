#pragma once
#include <vector>

#include "ball_fit.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/random.h"
#include "spots.h"

namespace orchard::detail {

// Points of the surface that a level's balls must hold, each with a start for the centre of a ball near it.
struct Samples {
  std::vector<Point> points, starts;
  Index size() const { return static_cast<Index>(points.size()); }
};

struct LevelBall : FittedBall {
  Index region = kNone;        // that the ball answers for a part of
  std::vector<Index> samples;  // inside the ball and its region, ascending
};

// A level's objective is the sum over its balls of (looseness / R)^power (radius / R)^size_power.
struct LevelCost {
  double power = 4, size_power = 0;
};

struct LevelOptions {
  Index balls = 8;           // at most
  Index most_children = 16;  // balls in a region at most
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

  // Each spot goes to the ball that it costs least, and its deepest point becomes a sample; with `hold`, points near
  // its corners too.
  void take_in(const std::vector<Spot>& spots, bool hold);

  const std::vector<LevelBall>& balls() const { return balls_; }
  double objective() const;

 private:
  struct Trial;
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
  Trial propose(std::uint64_t number) const;
  bool apply(Trial& trial);

  struct Taker {
    Index ball = kNone;
    double rise = 0;  // of its cost
  };
  Taker cheapest_taker(std::span<const Point> spot) const;
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
