#pragma once
#include <optional>
#include <span>
#include <vector>

#include "contractible_mesh.h"

namespace orchard::detail {

// An elementary collapse: the edge that was taken away, and the third corner of its triangle.
struct Collapse {
  Index a, b, c;
};

// Collapses that free an edge which the link condition holds: most often a triangle of two sheets' borders stands in
// its way, such as a narrow fin's. Takes them on the mesh, and returns them in order; nothing, the mesh as it was, if
// there are none, or more than a few. Precondition: a and b are adjacent. Deterministic.
std::optional<std::vector<Collapse>> open_link(ContractibleMesh& mesh, Index a, Index b);

// The mesh as it was before these collapses, if nothing else was done since.
void undo(ContractibleMesh& mesh, std::span<const Collapse> collapses);

}  // namespace orchard::detail
