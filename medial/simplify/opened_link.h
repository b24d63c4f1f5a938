#pragma once
#include <optional>
#include <span>
#include <vector>

#include "contractible_mesh.h"

namespace orchard::detail {

// An elementary collapse: the edge that was removed, and the third corner of its triangle.
struct Collapse {
  Index a, b, c;
};

// Applies collapses to a mesh such that the link condition allows to contract the edge ab, and returns them in order.
// Most often, the obstacle is a triangle with two border edges, such as that of a narrow fin. Returns nullopt and
// leaves the mesh unchanged if no collapses help, or if more than a few were necessary. Precondition: a and b are
// adjacent. The result is deterministic.
std::optional<std::vector<Collapse>> open_link(ContractibleMesh& mesh, Index a, Index b);

// Restores the mesh as it was before these collapses. Precondition: nothing else has changed it since.
void undo(ContractibleMesh& mesh, std::span<const Collapse> collapses);

}  // namespace orchard::detail
