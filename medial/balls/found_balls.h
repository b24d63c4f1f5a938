#pragma once
#include <span>
#include <vector>

#include "exact_ball.h"

namespace orchard::detail {

// A cache of exact balls: the start and seeds of a search give its result. An axis of nearly the same points needs most
// of them again.
class FoundBalls {
 public:
  // The ball that BallSolver::solve() found from this start and these seeds; nullptr if that is not known. O(1). Any
  // number of threads may call it while nothing is added.
  const ExactBall* find(const Point& start, std::span<const ClosestPoint> seeds) const;
  void add(const Point& start, std::span<const ClosestPoint> seeds, const ExactBall& ball);

 private:
  struct Entry {
    Point start;
    std::size_t seeds;  // where the entry's seeds begin
    ExactBall ball;
  };
  // The entry's place in the table; if there is none, the free place where it belongs.
  std::size_t place_of(const Point& start, std::span<const ClosestPoint> seeds) const;
  std::span<const ClosestPoint> seeds_of(Index entry) const;
  void grow();

  std::vector<Entry> entries_;
  std::vector<ClosestPoint> seeds_;
  std::vector<Index> table_;  // of entries, by hash; a power of two, at most half of it used
};

}  // namespace orchard::detail
