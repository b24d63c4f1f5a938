#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// What an incremental algorithm had to do. Every point that was inserted counts under one of the insertions but the
// first four. Inagaki's are all constrained ones, Bowyer's all certified.
struct InsertionReport {
  int dimension = 0;                         // of what the points span; below 3 there are no vertices
  std::uint64_t certified_insertions = 0;    // every sign on the cavity's border was beyond doubt
  std::uint64_t settled_insertions = 0;      // some vertex was marginal: leaving all such gave a consistent cell
  std::uint64_t exact_insertions = 0;        // the same, after exact arithmetic had settled doubts
  std::uint64_t constrained_insertions = 0;  // the search under the five constraints decided
  // All insertions were made with exact signs: a sample was in doubt, too many needed them, or it was too wrong.
  bool exact_signs = false;
  double certified_intrusion =
      0;  // over the bounding radius: no point lies deeper in a sphere or farther beyond the hull
  std::uint64_t coplanar_centers = 0;            // circumcentres approximated by a neighbour's position
  std::vector<std::array<Index, 2>> duplicates;  // (point left out, point it coincides with), ascending
};

}  // namespace orchard
