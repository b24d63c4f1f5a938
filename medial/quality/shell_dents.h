#pragma once
#include "boundary_reach.h"

namespace orchard::detail {

// max_dent() between two depths: places of the boundary of the reconstruction whose depth in the solid is above `known`
// and at most `deepest` (mesh units), without cubes.
//
// A place of the solid whose nearest place of the surface is x lies along a normal there: below a face at its normal;
// below an edge or a vertex, where the solid is reflex, between those of the faces around. (At a vertex: what is in the
// polar cone of the surroundings is in the cone of the faces' normals, by Farkas' lemma.) So the places below a face,
// from the one depth to the other, are in the convex hull of six: its corners, moved by either along the normal; those
// below an edge of eight, those below a vertex of two for each face around. The cells of the reconstruction are convex:
// where one holds these corners it holds all of the hull, and no boundary is there. Where the solid is thinner than
// `deepest` the hull is cut: x is nearest only up to where another place q of the surface is as near, and that depth is
// a convex function of x.
//
// What no cell holds is halved, until `max_pieces` were looked at; faces, edges and vertices do not count. Some two
// tests of a cell for each of them where the surface is fine beside the cells: nothing is searched in trees there.
// Parallel, and the same for any number of threads. Precondition: one_sided(surface) (one_sided.h).
SearchedMax max_shell_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double deepest,
                           double accuracy, Index max_pieces);

}  // namespace orchard::detail
