#include "cover_candidates.h"

#include <tbb/parallel_for.h>

namespace orchard::detail {
namespace {

// An uncovered region is taken in whole unless that costs so many times what its farthest point does.
constexpr double kDearer = 8;

}  // namespace

std::vector<Taking> find_cover_candidates(const std::vector<UncoveredRegion>& uncovered,
                                          const CheapestCandidates& cheapest) {
  std::vector<Taking> takings(uncovered.size());
  tbb::parallel_for(std::size_t{0}, uncovered.size(), [&](std::size_t i) {
    const auto [whole, farthest] = cheapest(uncovered[i]);
    const bool together = whole.rise <= kDearer * farthest.rise;  // true if both are infinite, too: none takes it
    takings[i] = {together ? whole.ball : farthest.ball, together};
  });
  return takings;
}

}  // namespace orchard::detail
