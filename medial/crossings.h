#pragma once
#include <vector>

#include "cell_patches.h"
#include "orchard/medial/gap_crossing.h"

namespace orchard::detail {

// A part of the surface that a Voronoi cell should not reach, or should not hold as a whole.
struct Crossing {
  CellPatch patch;
  std::vector<Index> neighbors;  // cells whose face shared with patch.cell is at fault, ascending
  bool neck = false;             // the patch holds its point but is no disk among disks (neck_test.h)
};

// By the given definition, ascending by cell. Parallel.
std::vector<Crossing> find_gap_crossings(const Surface& surface, const SurfaceSampling& sampling,
                                         const RestrictedVoronoi& restricted, const RepairOptions& options);

std::vector<Crossing> find_necks(const Surface& surface, const SurfaceSampling& sampling,
                                 const RestrictedVoronoi& restricted);

// How many faces are at fault, each counted once.
Index count_faces(const std::vector<Crossing>& crossings);

}  // namespace orchard::detail
