#pragma once
#include "boundary_reach.h"

namespace orchard::detail {

// Searches, like max_dent(), for places of the boundary of the reconstruction whose depth in the solid is above `known`
// and at most `deepest` (mesh units), without cubes.
//
// A place of the solid whose nearest place of the surface is x lies along a normal there: below a face along its
// normal, and below an edge or a vertex where the solid is reflex, along a direction between the normals of the faces
// around it. (At a vertex, the polar cone of the surroundings is contained in the cone of the faces' normals, by
// Farkas' lemma.) So the places below a face between two depths are in the convex hull of six points, which are the
// corners of the face moved by both depths along the normal. Below an edge there are eight points, and below a vertex
// two for each face around it. The cells of the reconstruction are convex, so a cell that contains these points
// contains the whole hull, and the boundary does not pass through it. Where the solid is thinner than `deepest`, the
// hull is cut: x is the nearest place only up to the depth at which another place q of the surface is as near, and that
// depth is a convex function of x.
//
// Pieces that no cell contains are halved, until `max_pieces` have been examined, not counting whole faces, edges and
// vertices. Where the triangles of the surface are small compared with the cells, each of these takes about two tests
// of a cell and no search in a tree. Parallel; the result is the same for any number of threads. Precondition:
// one_sided(surface) (one_sided.h).
SearchedMax max_shell_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double deepest,
                           double accuracy, Index max_pieces);

}  // namespace orchard::detail
