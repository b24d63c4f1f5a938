#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/diagram.h"

namespace orchard {

// What the insertions had to do.
struct HighestFirstReport {
  std::uint64_t certified_insertions = 0;        // every sign on the cavity's border was beyond doubt
  std::uint64_t settled_insertions = 0;          // some vertex was marginal: leaving all such gave a consistent cell
  std::uint64_t exact_insertions = 0;            // the same, after exact arithmetic had settled doubts
  std::uint64_t constrained_insertions = 0;      // the value-ordered search under the five constraints decided
  bool exact_signs = false;                      // so many were, that all insertions were made anew with exact signs
  std::uint64_t coplanar_centers = 0;            // circumcentres approximated by a neighbour's position
  std::vector<std::array<Index, 2>> duplicates;  // (point left out, point it coincides with)
};

// The Voronoi diagram by incremental insertion with the highest-first deletion search under Inagaki et al.'s five
// constraints (dissertation 6.2.3): consistent for every input, and as near to Voronoi as rounding allows. Points
// within tolerance::kCoincidentPoints of the bounding radius of an earlier point form no vertex. Deterministic. Throws
// InputError for fewer than four points or points that all lie in a plane. About O(n log n) on surface points.
VoronoiDiagram highest_first_voronoi(std::span<const Point> points, const Progress& progress = {},
                                     HighestFirstReport* report = nullptr);

// Adds points to a diagram that highest_first_voronoi made; a rebuild agrees up to rounding. Vertices are renumbered.
void insert_points(VoronoiDiagram& diagram, std::span<const Point> points, HighestFirstReport* report = nullptr);

}  // namespace orchard
