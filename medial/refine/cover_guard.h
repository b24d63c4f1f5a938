#pragma once
#include <span>
#include <vector>

#include "../balls/ball_complex.h"

namespace orchard::detail {

// Checks that places of the surface stay near to an axis while parts of the axis are removed. Each single removal may
// be harmless while all of them together remove a whole axis: of a cylinder, first the two cones, since each hangs on
// the rest by one vertex, and then the curve between them, from its ends. The guard checks the same places each time,
// so that losses add up.
class CoverGuard {
 public:
  // `limit` (mesh units) is the largest distance that a place may have from the balls of the axis. `places` must
  // outlive the guard.
  CoverGuard(std::span<const Point> places, double limit) : places_(places), limit_(limit) {}

  // Returns 1 for each piece that must not be removed, because some place is within reach of the balls of the piece and
  // of no cell that stays. `piece_of_edge` has the number of the piece for each edge of a complete complex, or kNone; a
  // triangle belongs to the piece of any of its edges that has one. Parallel, deterministic. O(n log n) and two queries
  // for each place.
  std::vector<std::uint8_t> needed(const BallComplex& complex, const std::vector<Index>& piece_of_edge) const;

 private:
  std::span<const Point> places_;
  const double limit_;
};

}  // namespace orchard::detail
