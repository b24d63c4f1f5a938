#pragma once
#include <cstddef>
#include <vector>

#include "ball_fit.h"

namespace orchard::detail {

// Where balls lie, side by side, for the search's most frequent question.
class BallPlaces {
 public:
  void resize(Index count);
  void set(Index ball, const FittedBall& now);

  // How far a ball is from another: to its centre, less half its radius.
  // The other balls that may be among the `count` nearest to a ball once each one's distance was multiplied by a number
  // from `least` to `most`, both above 0; ascending. About one step for each four balls.
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
