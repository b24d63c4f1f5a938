#pragma once
#include <cstdint>
#include <span>

#include "collision/pair_walk.h"
#include "collision/workspace_scratch.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime::detail {

// A body that is a solid box. It comes with a point of each connected piece of the other body's surface, because a
// piece that lies wholly inside the box meets no triangle of it and still is in the way.
struct SolidBox {
  bool is_first;                 // whether the box is the first body
  Vec3 half;                     // half of the side lengths
  std::span<const Vec3> pieces;  // in the frame of the other body
};

// The input of minimum_translation(). The second tree is moved, in the first tree's frame and units.
struct MinimumTranslationSearch {
  const PlacedPair& pair;
  WalkStack& room;
  std::span<const Workspace::Scratch::Cut> cuts;  // triangles that meet at the present place; others may meet, too
  std::span<const SolidBox> solids;
  double size;         // the size of both bodies together
  double nudge;        // a step beyond a contact, longer than the rounding error of poses
  std::uint64_t work;  // the search ends when room.work reaches this
};

// A translation of the second tree after which no triangle of it meets any of the first one, and no piece of a surface
// is inside a solid box.
struct MinimumTranslation {
  Vec3 direction;
  double way;          // the length; at its end, the bodies are apart, rounding included
  Vec3 normal;         // the normal of the last contact on the way, pointing along the direction
  bool ended;          // false if the search was given up
  bool clear = false;  // at the end, no triangles are so close that rounding of poses could make them meet
};

// Returns the first of the points of `solid.pieces` that is inside the box at the present place of the second tree, or
// null.
const Vec3* piece_inside(const MinimumTranslationSearch& search, const SolidBox& solid) noexcept;

// Finds a short translation that separates the bodies. `directions` has at least one direction. The search has these
// parts:
//   1. It follows each direction until the last triangles part, at a face or at two edges. It then tries the normal of
//      these, and the shortest way past the last two of such planes, at most `refinements` times for each direction.
//   2. If `refinements` is not 0, it tries directions all around, so that the result does not depend on a wrong first
//      direction. If the translation so far is long compared with the bodies or with the contact, any shorter one is
//      accepted; otherwise, only one that is much shorter.
//   3. If the work is spent before any direction has come to its end, the result is a translation after which the
//      extents of the bodies along it do not overlap, and `ended` is false.
MinimumTranslation minimum_translation(const MinimumTranslationSearch& search, std::span<const Vec3> directions,
                                       std::uint32_t refinements) noexcept;

}  // namespace orchard::runtime::detail
