#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// Orders points such that each is near the one before.
namespace orchard {

// Returns the numbers of the points in the order of a Hilbert curve, by CGAL's hilbert_sort(). Work that starts from
// the result for the point before is faster in this order than in that of a mesh, in which neighbours need not follow
// each other. Deterministic; O(n log n).
std::vector<std::size_t> spatial_order(std::span<const Point> points);

}  // namespace orchard
