#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Returns an order in which to insert points: rounds of random samples, each several times as large as all before it,
// and within a round along a Hilbert curve. The rounds keep cells small while the diagram grows (Amenta, Choi, Rote
// 2003), and the curve keeps each point near the previous one. The order depends only on the points and their box,
// which must contain them.
std::vector<Index> insertion_order(std::span<const Point> points, const Box& box);

}  // namespace orchard::detail
