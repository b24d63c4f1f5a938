#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/medial/axis.h"

namespace orchard::detail {

// What merging starts with: medial vertices or single surface points, each with the surface points that it must
// contain.
struct Parts {
  std::vector<Sphere> spheres;
  std::vector<std::vector<Index>> points;      // the points of the axis that each part must contain, ascending
  std::vector<std::array<Index, 2>> adjacent;  // pairs of parts, the lower first
};

// Parts merged into one sphere.
struct MergedParts {
  Sphere sphere;             // contains the points, up to those that the group's core leaves out
  std::vector<Index> parts;  // ascending
};

// Merges adjacent groups of parts, the cheapest merge first, until targets[i] groups remain, for each i in turn
// (dissertation 6.3.1). Where no groups are adjacent any more, the smallest group joins the one that is cheapest to
// join. Ties go to the lowest indices. Precondition: targets descend.
std::vector<std::vector<MergedParts>> merge_parts(const MedialAxis& axis, const Parts& parts,
                                                  std::span<const std::size_t> targets);

// Moves and shrinks the sphere towards the smallest one that holds the points (Badoiu and Clarkson 2003).
void shrink_around(const std::vector<Point>& points, Sphere& sphere);

}  // namespace orchard::detail
