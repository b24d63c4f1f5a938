#pragma once
#include <span>

#include "fit.h"

namespace orchard::detail {

// Contracts edges, the cheapest first, until at most `target` vertices are left or no edge may be contracted. It
// continues down to `free_target` with edges whose new ball is within `free_distance` (mesh units) of its planes in the
// mean. On the axis of a solid with flat faces, this holds everywhere until only seams and corners are left.
//
// The cost is a quadric in centre and radius (Li et al. 2015): the squared distances of the ball to the planes that
// touch the slabs and cones around its vertices. These planes do not show that the envelope ends at the border of a
// sheet. So each border edge adds a plane that touches it from beyond the sheet. A ball that moves inwards from a
// border whose sheet ends at radius 0 then pays for the loss of the solid there. O(n log n).
//
// A mean over planes hides small sheets beside large ones. So every fourth sample of the surface is a guard. A
// contraction that moves the envelope farther from a guard than a limit, or whose ball protrudes farther than that,
// waits until no other contraction is left. Then the limit, which is `min_limit` (mesh units) at first, is doubled.
// Below `target` there are guards only if the result without guards is inaccurate.
void contract_by_slabs(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Index target,
                       Index free_target, double free_distance, double min_limit);

}  // namespace orchard::detail
