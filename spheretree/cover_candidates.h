#pragma once
#include <functional>
#include <limits>
#include <vector>

#include "uncovered_regions.h"

// Which balls take uncovered regions in: what the closing of a merged level (merging/merge_closing.h) and that of a
// tightened one (tightened/level_closing.h) have in common.
namespace orchard::detail {

// Queries of the signed distance to fit a ball again to what it has taken in.
inline constexpr int kCandidateEvaluations = 14;
// What breaks ties between balls that would not get looser at all, as a fraction of growth over R.
inline constexpr double kCandidateTie = 1e-9;

struct CoverCandidate {
  Index ball = kNone;
  double rise = std::numeric_limits<double>::infinity();  // of its cost
};

// Of the balls that can hold an uncovered region's points(), and of those that can hold its farthest one alone, the one
// that this costs least.
struct CoverCandidates {
  CoverCandidate whole, farthest;
};

using CheapestCandidates = std::function<CoverCandidates(const UncoveredRegion&)>;  // called by several threads

struct Taking {
  Index ball = kNone;  // none: no ball can hold even the farthest point
  bool whole = false;  // takes the region's corners in as well as its farthest point
};

// Where each uncovered region goes: as a whole to the ball that this costs least, unless that costs many times what its
// farthest point alone does, or no ball can hold it. Then it is a long sliver, or lies across the border of a path
// region, and will fall apart: only its farthest point goes, to the ball that this costs least. Parallel over the
// regions.
std::vector<Taking> find_cover_candidates(const std::vector<UncoveredRegion>& uncovered,
                                          const CheapestCandidates& cheapest);

}  // namespace orchard::detail
