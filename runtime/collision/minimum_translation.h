#pragma once
#include <cstdint>
#include <span>

#include "collision/pair_walk.h"
#include "collision/workspace_scratch.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// A body that is a box with its inside, and a point of each connected piece of the other body's surface, in that body's
// frame: a piece that lies wholly inside meets no triangle, and still is in the way.
struct SolidBox {
  bool is_first;
  Vec3 half;
  std::span<const Vec3> pieces;
};

// What a way out is looked for in. The second tree is moved, in the first tree's frame and units.
struct MinimumTranslationSearch {
  const PlacedPair& pair;
  WalkStack& room;
  std::span<const Workspace::Scratch::Cut> cuts;  // triangles that meet where the second one is now; more may
  std::span<const SolidBox> solids;
  double size;         // of both bodies
  double nudge;        // beyond a contact: more than what rounding does to poses
  std::uint64_t work;  // of the walk, at which the search ends
};

// How far the second tree has to move along a direction until no triangle of it meets any of the first one, and no
// piece of a surface is inside a box.
struct MinimumTranslation {
  Vec3 direction;
  double way;          // at its end the bodies are free of each other, rounding included
  Vec3 normal;         // of what the surfaces leave each other in at its end, pointing along the direction
  bool ended;          // false: given up
  bool clear = false;  // at its end no triangles are so close that rounding of poses could make them meet
};

// The first of the points of pieces that are inside a box where the second tree is now, or null.
const Vec3* piece_inside(const MinimumTranslationSearch& search, const SolidBox& solid) noexcept;

// The shortest way out that is found from `directions` on, at least one of them, by following what is in the way: where
// the last triangles part at a face or two edges, the way across these is tried next, or the shortest one past the last
// two of them, at most `refinements` times from each. Directions all around are tried as well, so that no wrong first
// direction decides: for any shorter way where that one is long beside the bodies or the contact, else for one that is
// shorter by far. Where no direction comes to an end in time, the way is one to where the bodies' extents part, and
// `ended` is false.
MinimumTranslation minimum_translation(const MinimumTranslationSearch& search, std::span<const Vec3> directions,
                                       std::uint32_t refinements) noexcept;

}  // namespace orchard::runtime::detail
