#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/collide.h"

// Finds where two bodies touch and the shortest translation that separates them, for the response to a contact.
namespace orchard::runtime {

inline constexpr std::uint32_t kMaxContactPoints = 4;

// A point of a contact.
struct ContactPoint {
  std::array<double, 3> place{};  // A point of both surfaces, in world coordinates.
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  // How far b has to move along the normal until these two triangles are certainly apart, in world units; at most
  // Manifold::depth. A negative value means that the triangles do not meet, and is minus their distance (see
  // ContactOptions::margin).
  double depth = 0;
};

// The contact of two bodies.
struct Manifold {
  Answer answer = Answer::maybe;
  // The number of points; 0 for "no" without a margin. They are the outermost ones that were found, seen along the
  // normal.
  std::uint32_t count = 0;
  std::array<ContactPoint, kMaxContactPoints> points{};
  // A unit vector from a to b. After b has moved by `depth` along it, b does not touch a any more, rounding included;
  // after moving by less than `depth` - `error`, it still does. Of the directions that were tried, it is the one with
  // the smallest depth, and a local minimum. The search tries directions all around as far as
  // ContactOptions::effort allows, but may miss a better one. For
  // "maybe", the normal is a guess: the direction from one sphere to the other.
  std::array<double, 3> normal{};
  double depth = 0;
  // The error of points and depth. For "yes", it is rounding, about 1e-12 of the coordinates. For "maybe", it is the
  // radius of a ball around the point that contains the common part of two of the trees' spheres.
  double error = 0;
  // False if the search was given up before it knew the exact depth of any direction. `depth` is then the one after
  // which the extents of the bodies along the normal do not overlap. It separates the bodies, but may be larger than
  // necessary.
  bool complete = true;
};

// The options of contacts().
struct ContactOptions {
  // The maximum number of directions that are tried from each initial direction; 0 computes only the depth of the first
  // normal. Higher values find smaller depths and take longer.
  std::uint32_t refinements = 12;
  // The work that the search for the depth may take, as a multiple of the work of finding the contact; at least 0,
  // which other values count as. Shallow contacts need less than the default. If bodies are deep in each other, the
  // search ends with the best depth so far, or with the extents of the bodies (Manifold::complete). Infinity searches
  // to the end, which may take 100 times as long.
  double effort = 0.5;
  bool depth = true;  // False: points and a first normal only, at a fraction of the cost.
  // The largest distance, in world units, of surfaces that get a point before they touch. The point is the middle
  // between the two nearest points, the normal is the direction from a to b, and both depths are minus the distance.
  // The answer is still "no". Costs a distance query.
  double margin = 0;
};

// Returns where two bodies touch. The points lie on the curves in which the surfaces cut each other, which are found
// from all pairs of triangles that meet. The depth along a direction is the length of the shortest motion after which
// no triangle of one body meets any of the other, including triangles that get in the way during the motion. It is
// exact for the stored triangles up to rounding. If one solid is deep inside the other, the motion separates the
// *surfaces*, so the solid may still be inside afterwards.
Manifold contacts(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const ContactOptions& options = {}) noexcept;

// The distance of two surfaces, or minus the manifold's depth if they meet, in world units. For shallow contacts it is
// continuous in the poses. `normal` is the direction in which b has to move away from a.
struct SignedDistance {
  double lower = 0, upper = 0;  // lower <= distance <= upper; equal for contacts.
  std::array<double, 3> on_a{}, on_b{}, normal{};
};
SignedDistance signed_distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                               double relative_tolerance = 0.01) noexcept;

}  // namespace orchard::runtime
