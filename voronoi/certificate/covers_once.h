#pragma once
#include <span>
#include <vector>

#include "workspace/workspace.h"

namespace orchard::detail {

// Whether the middle of a tetrahedron is below all facets of the hull, which are those of vertices at infinity, and a
// ray from there meets exactly one of them. As all tetrahedra are oriented positively, no two overlap in that case, and
// the hull encloses them once (see certify()). `box` is that of the points. O(n) for n facets.
bool covers_once(const Workspace& workspace, std::span<const Index> hull, Index tetrahedron, const Box& box);
// The facets that it is not below.
std::vector<Index> facets_above(const Workspace& workspace, std::span<const Index> hull, Index tetrahedron);

}  // namespace orchard::detail
