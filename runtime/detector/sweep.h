#pragma once
#include "detector/shape_placements.h"
#include "orchard/runtime/time_of_impact.h"

namespace orchard::runtime::detail {

// The result of sweep(). Times are from 0, at the first pose, to 1, at the second one.
struct Swept {
  Answer answer = Answer::no;  // whether they touch between the two poses; maybe: this is not known from `from` on
  double from = 0, to = 1;     // certified: they do not touch before `from`; yes: they do at `to`
  Verdict verdict{};           // at `to`
};

// Returns whether and when two parts touch while both move from one pose to the other in one unit of time, as
// travel_between() describes for the centre of each part's sphere. It calls time_of_impact(), with a round shape as a
// segment and its radius as the margin; towards a half-space, it advances conservatively along the normal. It adds what
// it costs to `work`, and stops once this has reached `most`, with an overshoot of less than kMaxOvershoot. The answer
// is maybe if it was stopped before the end, if a pose is not rigid, or if a scale changes.
Swept sweep(Workspace& workspace, const PartPair& from, const PartPair& to, std::uint64_t most,
            std::uint64_t& work) noexcept;

}  // namespace orchard::runtime::detail
