#pragma once
#include "detector/shape_placements.h"
#include "orchard/runtime/time_of_impact.h"

namespace orchard::runtime::detail {

struct Swept {
  Answer answer = Answer::no;  // of whether they touch between the two poses; maybe: not known from `from` on
  double from = 0, to = 1;     // certified: they do not touch before `from`; yes: they do at `to`
  Verdict verdict{};           // at `to`
};

// What happens while both move from one pose to the other in one unit of time, as travel_between() says with the
// centre of the part's sphere: by time_of_impact(), a round shape being a segment with its radius as margin; towards a
// half-space by advancing along its normal. Ends once `work`, which it increases, has reached `most`, less than
// kMaxOvershoot beyond; what is not known by then is maybe, as are poses that are not rigid, or of two scales.
Swept sweep(Workspace& workspace, const PartPair& from, const PartPair& to, std::uint64_t most,
            std::uint64_t& work) noexcept;

}  // namespace orchard::runtime::detail
