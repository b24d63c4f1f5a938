#pragma once
#include <cstdint>
#include <span>

#include "pair_walk.h"
#include "workspace_scratch.h"

namespace orchard::runtime::detail {

// How far the second tree has to move along a direction until no triangle of it meets any of the first one, in the
// first tree's frame and units.
struct WayOut {
  Vec3 direction;
  double way;
  Vec3 normal;  // of what the surfaces leave each other in at its end, pointing along the direction
  bool ended;   // false: given up, the way is at least so long
};

// The shortest one that is found from `directions` on, at least one of them, by following what is in the way: where the
// last triangles part at a face or two edges, the way across these is tried next, or the shortest one that leaves all
// such obstacles behind. `cuts`: triangles that meet where the second one is now; more may.
WayOut least_way_out(const PlacedPair& pair, const WalkStack& room, std::span<const Workspace::Scratch::Cut> cuts,
                     std::span<const Vec3> directions, double size, std::uint32_t refinements) noexcept;

}  // namespace orchard::runtime::detail
