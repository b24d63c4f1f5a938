#pragma once
#include <span>
#include <vector>

#include "../balls/ball_complex.h"

namespace orchard::detail {

// Keeps places of the surface in reach of an axis that is being cleaned. Every single removal may be harmless, while
// all of them together eat a whole axis: a cylinder's two cones first, for each hangs on the rest by one vertex, then
// the curve between them, from its ends. The guard asks after the same places each time, so that losses add up.
class CoverGuard {
 public:
  // `limit` (mesh units): how far from the axis's balls a place may be. The places must outlive the guard.
  CoverGuard(std::span<const Point> places, double limit) : places_(places), limit_(limit) {}

  // Of pieces that are to be taken away, those that must stay, by their numbers: without them, a place that is in reach
  // of their balls is in reach of no cell that stays. `piece_of_edge`: the piece of each edge of a complete complex, or
  // kNone; a triangle is of the piece that one of its edges is of. Parallel, deterministic. O(n log n), and two queries
  // for each place.
  std::vector<std::uint8_t> needed(const BallComplex& complex, const std::vector<Index>& piece_of_edge) const;

 private:
  std::span<const Point> places_;
  const double limit_;
};

}  // namespace orchard::detail
