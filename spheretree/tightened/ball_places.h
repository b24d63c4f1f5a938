#pragma once
#include <cstddef>
#include <vector>

#include "ball_fit.h"

namespace orchard::detail {

// The places of balls, stored for vector instructions, for the most frequent query of the search.
class BallPlaces {
 public:
  void resize(Index count);
  void set(Index ball, const FittedBall& now);

  // Returns the other balls, ascending, that may be among the `count` nearest to a ball if the distance of each is
  // multiplied by some number between `least` and `most`, both above 0. The distance of a ball is that of its centre
  // less half its radius. Takes about one step for four balls.
  std::vector<Index> nearest(Index of, std::size_t count, double least, double most) const;

 private:
  static constexpr std::size_t kLanes = 4;
  // A GCC and Clang extension. The alignment is that of code for SSE: see wide.h.
  using Lanes = double __attribute__((vector_size(32), aligned(16)));
  struct Four {
    Lanes x, y, z, half_radius;
  };
  struct Near {
    double apart;
    Index ball;
  };
  struct Query {
    Index of;
    std::size_t count;
    double spread;  // most / least
    std::vector<Near>& near;
  };
  void gather(const Query& query) const;
  void gather_wide(const Query& query) const;

  Index count_ = 0;
  std::vector<Four> fours_;
};

}  // namespace orchard::detail
