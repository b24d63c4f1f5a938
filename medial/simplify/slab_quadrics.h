#pragma once
#include <span>

#include "fit.h"

namespace orchard::detail {

// Contracts edges, the cheapest first, until no more than `target` vertices are left or no edge may be contracted; and
// on to `free_target` where what an edge becomes is within `free_distance` (mesh units) of its planes in the mean, as
// everywhere on the axis of a solid with flat faces until its seams and corners alone are left.
//
// The cost is a quadric in centre and radius (Li et al. 2015): the squared distances of the ball to the planes that
// touch the slabs and cones around its vertices. A border of a sheet is a place where the envelope ends, which these
// planes do not see; so each border edge adds the plane that touches it from beyond the sheet: a ball that moves in
// from a border whose sheet ends at radius 0 pays what the solid loses there. O(n log n).
//
// A mean over planes hides a small one beside large sheets, so every fourth sample of the surface stands guard: a
// contraction that takes one of them farther off than a limit, or whose ball protrudes farther, waits until no other is
// left; then the limit, `min_limit` (mesh units) at first, is doubled. Below `target` they stand guard only if what is
// left without one is off.
void contract_by_slabs(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Index target,
                       Index free_target, double free_distance, double min_limit);

}  // namespace orchard::detail
