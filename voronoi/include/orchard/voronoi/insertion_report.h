#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

// The report of the incremental Voronoi algorithms.
namespace orchard {

// How the points were inserted, and what is certified of the diagram. Every inserted point after the first four counts
// under exactly one of the four kinds of insertions. All insertions of inagaki_voronoi() are constrained ones, and all
// of bowyer_voronoi() certified ones.
struct InsertionReport {
  // The dimension that the points span. If it is below 3, the diagram has no vertices.
  int dimension = 0;
  // Insertions in which every sign at the border of the cavity was certain.
  std::uint64_t certified_insertions = 0;
  // Insertions with uncertain signs, in which keeping all vertices with such signs gave a consistent cell.
  std::uint64_t settled_insertions = 0;
  // Insertions in which exact arithmetic decided the uncertain signs.
  std::uint64_t exact_insertions = 0;
  // Insertions that were made by the search under the dissertation's five constraints.
  std::uint64_t constrained_insertions = 0;
  // Whether all insertions used exact signs. This happens if a sample of the points had uncertain signs, if too many
  // insertions needed exact signs, or if the diagram was too inaccurate without them.
  bool exact_signs = false;
  // The certified bound, over the bounding radius: no point lies deeper in a vertex's sphere or farther beyond the
  // hull.
  double certified_intrusion = 0;
  // Circumcentres that were approximated by the position of a neighbour.
  std::uint64_t coplanar_centers = 0;
  // Pairs of a point that was left out and the point that it coincides with, ascending.
  std::vector<std::array<Index, 2>> duplicates;
};

}  // namespace orchard
