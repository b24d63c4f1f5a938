#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "contractible_mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

inline constexpr double kLookSpacing = 0.04;      // bounding radii, of balls of edges that are looked at
inline constexpr double kThick = 8.0;             // of the samples' spacing: radii of balls that samples see enough of
inline constexpr double kNegligible = 0.1;        // of the largest distance: what protrudes no more counts as nothing
inline constexpr double kProtrusionWeight = 4.0;  // of a ball that protrudes, in samples

// A ball of a medial mesh that reaches out of the solid: what it takes of which corners, how far it reaches (mesh
// units), and the way there. Where a sheet ends with radius 0, or next to none, no place of the surface need be inside
// of what reaches out, so it has to be looked for from the balls.
struct Protrusion {
  std::array<Index, 3> corners{};   // smaller cells repeat the first
  std::array<double, 3> weights{};  // of corners that are repeated: 0
  double value = 0;
  Vector outward = Vector::Zero();

  Ball4 ball(const ContractibleMesh& mesh) const {
    return weights[0] * mesh.ball(corners[0]) + weights[1] * mesh.ball(corners[1]) + weights[2] * mesh.ball(corners[2]);
  }
};

// Where to look at balls; mesh units.
struct LookOptions {
  double spacing = std::numeric_limits<double>::infinity();     // of balls inside edges, at most; three at most
  double max_radius = std::numeric_limits<double>::infinity();  // of balls inside cells; larger ones are left out
  bool cells = true;  // inside edges and triangles, too, not at vertices alone

  // As much as samples of the surface need beside them, each of which stands for so much of its area: what protrudes of
  // balls much thicker than the samples are apart has some of them inside.
  LookOptions(const Surface& surface, double share)
      : spacing(kLookSpacing * surface.bounding_radius()),
        max_radius(kThick * std::sqrt(surface.report().area * share)) {}
  LookOptions() = default;
};

// Balls to look at: those of the vertices, at even steps inside edges, and in the middles of triangles. Values are not
// known.
std::vector<Protrusion> places_to_look(const ContractibleMesh& mesh, const LookOptions& options);

// The same for all cells at one of two vertices, or both.
std::vector<Protrusion> places_around(const ContractibleMesh& mesh, Index a, Index b, const LookOptions& options);

// A ball inside the solid, with nothing of the surface in it: what it holds needs no test of being inside. That is true
// whatever becomes of the medial mesh, so it is worth keeping from one look at a place to the next.
struct InsideBall {
  Point center = Point::Zero();
  double radius = 0;  // 0: none is known

  bool holds(const Point& place) const { return (place - center).norm() < kSure * radius; }
  bool holds(const Sphere& ball) const { return (ball.center - center).norm() + ball.radius < kSure * radius; }

 private:
  static constexpr double kSure = 1 - 1e-9;  // rounding
};

// How far a ball reaches out of the solid, and the way there; 0 if that is no more than `negligible`. `known` becomes a
// ball around the centre unless it holds all that counts already, so that nothing has to be looked for while the ball
// moves by less than `negligible`.
double protrusion_of(const Surface& surface, const Ball4& ball, double negligible, InsideBall& known, Vector& outward);

// Those of `places` that protrude by more than `negligible`; known: one for each place. Parallel.
std::vector<Protrusion> find_protrusions(const Surface& surface, const ContractibleMesh& mesh,
                                         const std::vector<Protrusion>& places, double negligible,
                                         std::span<InsideBall> known);

}  // namespace orchard::detail
