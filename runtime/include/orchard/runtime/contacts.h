#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/collide.h"

// Where two bodies touch and how they come apart, for the response to a contact.
namespace orchard::runtime {

inline constexpr std::uint32_t kMaxContactPoints = 4;

// A point of a contact.
struct ContactPoint {
  std::array<double, 3> place{};  // A point of both surfaces, in world coordinates.
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  // How far b has to move along the normal until these two triangles are certainly apart, at most Manifold::depth. A
  // negative value is minus their distance (ContactOptions::margin). In world units.
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
  // after moving by less than `depth` - `error`, it does. The direction is a local minimum of depth(direction), the
  // best one that was found. The search covers all directions, but may miss a shorter one. For "maybe" it is a guess,
  // from sphere to sphere.
  std::array<double, 3> normal{};
  double depth = 0;
  // The error of points and depth. For "yes", it is rounding, about 1e-12 of the coordinates. For "maybe", it is the
  // radius of a ball around the point that contains the common part of two of the trees' spheres.
  double error = 0;
  // False if no direction reached its first end in time. The depth is then that at which the extents of the bodies
  // along the normal separate. It is sufficient, but a smaller one may be as well.
  bool complete = true;
};

// The options of contacts().
struct ContactOptions {
  // The maximum number of directions that are tried from each initial direction; 0 computes the depth of the first
  // normal only. More find shorter ways and take longer.
  std::uint32_t refinements = 12;
  bool depth = true;  // False: points and a first normal only, at a fraction of the cost.
  // Surfaces that do not meet and are at most this far apart (world units) get one point before they touch: the middle
  // between the two nearest points, with the direction from a to b, and with minus their distance as its depth and the
  // manifold's. The answer is still "no". Costs a distance query.
  double margin = 0;
};

// Returns where two bodies touch. All pairs of triangles that meet give the curves in which the surfaces cut each
// other, and the points lie on these curves. The depth along a direction is exact for the stored triangles up to
// rounding: the shortest motion after which no triangle of one body meets any of the other, including every triangle
// that gets in the way. If one solid is deep in the other, this is the motion after which the *surfaces* are apart,
// which may end within the solid.
Manifold contacts(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const ContactOptions& options = {}) noexcept;

// The distance of two surfaces, or minus the manifold's depth if they meet. For shallow contacts it is continuous in
// the poses. `normal` is the direction in which b leaves a. In world units.
struct SignedDistance {
  double lower = 0, upper = 0;  // lower <= distance <= upper; equal for contacts.
  std::array<double, 3> on_a{}, on_b{}, normal{};
};
SignedDistance signed_distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                               double relative_tolerance = 0.01) noexcept;

}  // namespace orchard::runtime
