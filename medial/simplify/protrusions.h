#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "contractible_mesh.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

inline constexpr double kLookSpacing = 0.04;      // the spacing of balls that are tested on edges, in bounding radii
inline constexpr double kThick = 8.0;             // samples suffice for balls with larger radii, in sample spacings
inline constexpr double kNegligible = 0.1;        // smaller protrusions are ignored, in largest distances
inline constexpr double kProtrusionWeight = 4.0;  // the weight of a ball that protrudes, in samples

// A ball of a medial mesh that protrudes from the solid: its weights on the corners of its cell, how far it protrudes
// (in mesh units), and the direction. Where a sheet ends with a radius of almost 0, no sample of the surface need lie
// in the protruding part, so protrusions have to be searched from the balls.
struct Protrusion {
  std::array<Index, 3> corners{};   // edges and vertices repeat the first one
  std::array<double, 3> weights{};  // 0 for repeated corners
  double value = 0;
  Vector outward = Vector::Zero();

  Ball4 ball(const ContractibleMesh& mesh) const {
    return weights[0] * mesh.ball(corners[0]) + weights[1] * mesh.ball(corners[1]) + weights[2] * mesh.ball(corners[2]);
  }
};

// Which balls are tested. Lengths are in mesh units.
struct LookOptions {
  double spacing = std::numeric_limits<double>::infinity();     // the largest spacing of balls inside an edge
  double max_radius = std::numeric_limits<double>::infinity();  // larger balls inside cells are not tested
  bool cells = true;  // whether balls inside edges and triangles are tested, too

  // The tests that are necessary in addition to samples of the surface, each of which stands for `share` of its area.
  // Balls with radii far above the spacing of the samples need no test, because a protruding part contains samples.
  LookOptions(const Surface& surface, double share)
      : spacing(kLookSpacing * surface.bounding_radius()),
        max_radius(kThick * std::sqrt(surface.report().area * share)) {}
  LookOptions() = default;
};

// Returns the balls to test: those of the vertices, balls at even steps inside edges, and those at the middles of
// triangles. Their values are not set.
std::vector<Protrusion> places_to_look(const ContractibleMesh& mesh, const LookOptions& options);

// Returns the same for the cells at either of two vertices.
std::vector<Protrusion> places_around(const ContractibleMesh& mesh, Index a, Index b, const LookOptions& options);

// A ball inside the solid that contains no part of the surface. Whatever lies in it is inside the solid without a test.
// This does not depend on the medial mesh, so the ball is kept from one test at a place to the next.
struct InsideBall {
  Point center = Point::Zero();
  double radius = 0;  // 0 if no such ball is known

  bool holds(const Point& place) const { return (place - center).norm() < kSure * radius; }
  bool holds(const Sphere& ball) const { return (ball.center - center).norm() + ball.radius < kSure * radius; }

 private:
  static constexpr double kSure = 1 - 1e-9;  // the margin for rounding
};

// Returns how far a ball protrudes from the solid, or 0 if that is at most `negligible`, and stores the direction. If
// `known` does not contain the ball, it becomes a ball around its centre, so that no query is necessary while the ball
// moves by less than `negligible`.
double protrusion_of(const Surface& surface, const Ball4& ball, double negligible, InsideBall& known, Vector& outward);

// Returns those of `places` that protrude by more than `negligible`. `known` has an element for each place. The work is
// parallel.
std::vector<Protrusion> find_protrusions(const Surface& surface, const ContractibleMesh& mesh,
                                         const std::vector<Protrusion>& places, double negligible,
                                         std::span<InsideBall> known);

}  // namespace orchard::detail
