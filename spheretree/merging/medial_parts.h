#pragma once
#include <vector>

#include "merging/merger.h"

// The parts of a medial axis that merging starts with.
namespace orchard::detail {

// Scratch arrays of one thread. They are reset after each use.
struct PartScratch {
  std::vector<Index> part_of;  // each vertex
  std::vector<char> wanted;    // each point
};

// One part for each vertex, with those of its forming points that are among `wanted`. A vertex with none is left out.
Parts vertex_parts(const MedialAxis& axis, const std::vector<Index>& vertices, const std::vector<Index>& wanted,
                   PartScratch& scratch);

// One part for each point, adjacent to the points next to it. O(n^2): meant for the few points of few vertices.
Parts point_parts(const MedialAxis& axis, const std::vector<Index>& points);

}  // namespace orchard::detail
