#pragma once
#include <array>
#include <span>

#include "exact_ball.h"
#include "sheet_extension.h"

namespace orchard::detail {

// A triangle that was added to a sheet: from an edge that was there to a new vertex.
struct Fin {
  Index vertex = kNone;
  std::array<Index, 2> base{kNone, kNone};
};

// Fills what is between fins that stand side by side, as where they reach for places along one ridge: from the line
// between their vertices to the shortest way over old edges between their bases. Only where the axis runs between the
// vertices, too. Each fin is joined to two others at most, the nearest ones. O(n log n) for n fins that are spread.
void join_fins(SheetExtension& sheets, BallSolver& solver, std::span<const Fin> fins);

}  // namespace orchard::detail
