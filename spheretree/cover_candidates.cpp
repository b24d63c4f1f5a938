#include "cover_candidates.h"

#include <tbb/parallel_for.h>

namespace orchard::detail {
namespace {

// A single ball covers an uncovered region as a whole unless that costs this many times as much as covering its
// farthest point.
constexpr double kDearer = 8;

}  // namespace

std::vector<Taking> find_cover_candidates(const std::vector<UncoveredRegion>& uncovered,
                                          const CheapestCandidates& cheapest) {
  std::vector<Taking> takings(uncovered.size());
  tbb::parallel_for(std::size_t{0}, uncovered.size(), [&](std::size_t i) {
    const auto [whole, farthest] = cheapest(uncovered[i]);
    // This is also true if both are infinite, in which case no ball covers it.
    const bool together = whole.rise <= kDearer * farthest.rise;
    takings[i] = {together ? whole.ball : farthest.ball, together};
  });
  return takings;
}

}  // namespace orchard::detail
