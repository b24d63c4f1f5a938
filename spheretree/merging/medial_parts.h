#pragma once
#include <vector>

#include "merging/merger.h"

// Parts of a medial axis to merge.
namespace orchard::detail {

// Marks in use by one thread; clear between uses.
struct PartScratch {
  std::vector<Index> part_of;  // each vertex
  std::vector<char> wanted;    // each point
};

// Vertices, each with those of its forming points that are among `wanted`; those with none are left out.
Parts vertex_parts(const MedialAxis& axis, const std::vector<Index>& vertices, const std::vector<Index>& wanted,
                   PartScratch& scratch);

// Points, each adjacent to those next to it. O(n^2), for the few points of few vertices.
Parts point_parts(const MedialAxis& axis, const std::vector<Index>& points);

}  // namespace orchard::detail
