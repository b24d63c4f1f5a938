#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "orchard/runtime/packed_tree.h"

// Trees of simple shapes, so that every query between trees answers about them, too: contacts, distances, times of
// impact. All of them throw std::bad_alloc only. A sphere, a capsule or a box with rounded edges is a point, a segment
// or a box asked about with a margin (closer_than(), ImpactOptions::margin).
// Queries are about surfaces: for a body that may lie wholly inside a box or hull ask touches_box(), touches_hull().
namespace orchard::runtime {

PackedSphereTree point_tree(const std::array<double, 3>& point);
PackedSphereTree segment_tree(const std::array<double, 3>& p, const std::array<double, 3>& q);
// Centred at the origin; half the edges' lengths, positive.
PackedSphereTree box_tree(const std::array<double, 3>& half);
// Of triangles as they are, the spheres' bounds unknown: for a few dozen triangles. For meshes there is `orchard
// build`.
PackedSphereTree triangles_tree(std::span<const std::array<double, 3>> vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles);
// The convex hull of points, with triangles outward; corners are points of those given. Nothing if they lie in a plane,
// or are not finite. Exact predicates decide; O(n h) for h facets.
std::optional<PackedSphereTree> hull_tree(std::span<const std::array<double, 3>> points);

}  // namespace orchard::runtime
