#pragma once
#include <span>
#include <vector>

#include "exact_ball.h"

namespace orchard::detail {

// Exact balls by what they were found from. An axis of nearly the same points asks for most of them another time.
class FoundBalls {
 public:
  // What BallSolver::solve() gave from this start and these seeds; nullptr if that is not known. O(1). For any number
  // of threads while nothing is added.
  const ExactBall* find(const Point& start, std::span<const ClosestPoint> seeds) const;
  void add(const Point& start, std::span<const ClosestPoint> seeds, const ExactBall& ball);

 private:
  struct Entry {
    Point start;
    std::size_t seeds;  // where its own begin
    ExactBall ball;
  };
  // Where it is in the table, or the free place where it belongs.
  std::size_t place_of(const Point& start, std::span<const ClosestPoint> seeds) const;
  std::span<const ClosestPoint> seeds_of(Index entry) const;
  void grow();

  std::vector<Entry> entries_;
  std::vector<ClosestPoint> seeds_;
  std::vector<Index> table_;  // of entries, by hash; a power of two, at most half of it used
};

}  // namespace orchard::detail
