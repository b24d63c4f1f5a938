#pragma once
#include <functional>
#include <limits>
#include <vector>

#include "uncovered_regions.h"

// Which ball each uncovered region is given to: the rule that the closing of a merged level (merging/merge_closing.h)
// and that of a tightened one (tightened/level_closing.h) share.
namespace orchard::detail {

// The number of queries of the signed distance in which a ball is fitted to a further region.
inline constexpr int kCandidateEvaluations = 14;
// Breaks ties between balls that would not get looser: this fraction of (growth / R) is added to the cost.
inline constexpr double kCandidateTie = 1e-9;

struct CoverCandidate {
  Index ball = kNone;
  double rise = std::numeric_limits<double>::infinity();  // by how much its cost rises
};

// whole: of the balls that can hold all of a region's points(), the cheapest. farthest: of the balls that can hold its
// farthest point, the cheapest for this point alone.
struct CoverCandidates {
  CoverCandidate whole, farthest;
};

using CheapestCandidates = std::function<CoverCandidates(const UncoveredRegion&)>;  // called by several threads

struct Taking {
  Index ball = kNone;  // kNone: no ball can hold even the farthest point
  bool whole = false;  // whether it takes the region's corners as well as its farthest point
};

// Decides where each uncovered region goes. It goes as a whole to the ball for which it is cheapest. But if no ball can
// hold it, or if that costs many times as much as its farthest point alone, the region is a long sliver or lies across
// the border of a path region: then only the farthest point goes to the ball for which that is cheapest, and the region
// will fall apart. Parallel over the regions.
std::vector<Taking> find_cover_candidates(const std::vector<UncoveredRegion>& uncovered,
                                          const CheapestCandidates& cheapest);

}  // namespace orchard::detail
