#pragma once
#include <array>
#include <cstdint>

#include "orchard/runtime/collide.h"

// Where two bodies touch and how they come apart: for a response to a contact.
namespace orchard::runtime {

inline constexpr std::uint32_t kMaxContactPoints = 4;

struct ContactPoint {
  std::array<double, 3> place{};  // common to both surfaces, in world coordinates
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;
  // How far b has to move along the normal until these two triangles are surely apart: at most Manifold::depth.
  // Negative: they are apart by so much (ContactOptions::margin).
  double depth = 0;
};

struct Manifold {
  Answer answer = Answer::maybe;
  std::uint32_t count =
      0;  // of points: 0 for "no" without a margin; the outermost ones of all that were found, seen along the normal
  std::array<ContactPoint, kMaxContactPoints> points{};
  // Unit, pointing from a to b: b moved by `depth` along it does not touch a any more, rounding included, and moved
  // less than that by more than `error` it does. The direction is a local minimum of depth(direction), the best of
  // those that were found: shorter ones are looked for all around, and can be missed. For "maybe" it is a guess, from
  // sphere to sphere.
  std::array<double, 3> normal{};
  double depth = 0;
  // Of points and depth. Yes: rounding, some 1e-12 of the coordinates. Maybe: the radius of a ball around the point
  // that holds the common part of two of the trees' spheres.
  double error = 0;
  // False if no direction came to its first end in time: the depth is then that at which the bodies' extents along the
  // normal part, so that the body moved by it is free, and a shorter one may be as well.
  bool complete = true;
};

struct ContactOptions {
  // Directions tried at most from each direction that is begun with; 0: only the first normal's depth.
  std::uint32_t refinements = 12;
  bool depth = true;  // false: points and a first normal only, at a fraction of the cost
  // Surfaces that do not meet, and are at most so far apart, have one point before they touch: the middle between the
  // two nearest points, with the direction from a to b, and minus their distance as its depth and the manifold's. The
  // answer is "no" all the same. World units; costs a distance query.
  double margin = 0;
};

// All pairs of triangles that meet give the curves in which the surfaces cut each other; the points are on these. The
// depth along a direction is exact for the stored triangles but for rounding: the least way at whose end no triangle
// of one meets any of the other, following every triangle of the bodies that gets in the way. Where one solid is deep
// in the other, that is the way to where the *surfaces* part, which may be within the solid.
Manifold contacts(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const ContactOptions& options = {}) noexcept;

// The distance of the surfaces, negative where they meet: then minus the manifold's depth. For shallow contacts, that
// is continuous in the poses. `normal` is the direction in which b leaves a.
struct SignedDistance {
  double lower = 0, upper = 0;  // lower <= distance <= upper; equal for contacts
  std::array<double, 3> on_a{}, on_b{}, normal{};
};
SignedDistance signed_distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                               double relative_tolerance = 0.01) noexcept;

}  // namespace orchard::runtime
