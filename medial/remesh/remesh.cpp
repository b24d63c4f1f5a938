#include "remesh.h"

#include <algorithm>
#include <numbers>

#include "orchard/geometry/angle.h"
#include "remesher.h"
#include "target_lengths.h"

namespace orchard::detail {
namespace {

constexpr double kCornerTurn =
    35 * std::numbers::pi / 180;          // the turn of a border on the surface from which on a vertex is a corner
constexpr double kOutsideTolerances = 2;  // tolerances: an edge that protrudes by more leads through the outside
constexpr double kMaxMidballShift = 0.3;  // of an edge's length: how far its exact ball may be from its middle
constexpr int kRings = 3;       // of neighbours of the vertices that may be changed: these may be changed, too
constexpr int kSmoothings = 2;  // in a round

}  // namespace

Index remesh(const Surface& surface, std::span<const Point> places, BallComplex& complex,
             std::span<const std::uint8_t> where, const RemeshOptions& options, const Progress& progress) {
  if (complex.size() == 0) return 0;
  Remesher remesher(surface, places, complex, where, options);
  remesher.run(progress);
  complex = remesher.complex();
  return remesher.moved();
}

Remesher::Remesher(const Surface& surface, std::span<const Point> places, const BallComplex& complex,
                   std::span<const std::uint8_t> where, const RemeshOptions& options)
    : surface_(surface),
      options_(options),
      mesh_(complex),
      errors_(surface, mesh_, options.tolerance),
      cover_(mesh_, places, options.limit),
      solver_(surface, options.merging),
      sharp_(surface, *options.features),
      open_(where.begin(), where.end()) {
  for (int ring = 0; ring < kRings; ++ring) widen();
}

void Remesher::run(const Progress& progress) {
  pin_corners();
  target_ = target_lengths(
      mesh_, errors_, {.least = options_.min_length, .most = options_.max_length, .tolerance = options_.tolerance});
  active_ = open_;
  for (int round = 0; round < options_.rounds; ++round) {
    drop_small_sheets();
    trim();
    split_long();
    split_wrong();
    collapse_short();
    flip();
    for (int i = 0; i < kSmoothings; ++i) smooth();
    report_progress(progress, "evening out the axis", (round + 1.0) / options_.rounds);
  }
}

// Allows changes to the neighbours of vertices that may be changed.
void Remesher::widen() {
  const std::vector<std::uint8_t> before = open_;
  for (Index c = 0; c < mesh_.cells(); ++c) {
    const Cell& cell = mesh_.corners(c);
    if (std::any_of(cell.begin(), cell.end(), [&](Index v) { return before[v] != 0; })) {
      for (const Index v : cell) open_[v] = 1;
    }
  }
}

// Pins the vertices where a border on the surface turns or leaves the surface, and the ends of edges that lead through
// the outside.
void Remesher::pin_corners() {
  std::vector<Index> along, corners;
  for (Index v = 0; v < mesh_.vertices(); ++v) {
    if (!mesh_.has(v) || !on_surface(v) || mesh_.stratum(v) != Stratum::border) continue;
    mesh_.neighbors_along(v, along);
    if (along.size() != 2) continue;
    const double turn =
        angle_between(mesh_.center(v) - mesh_.center(along[0]), mesh_.center(along[1]) - mesh_.center(v));
    // Two vertices as close as this count as the same place, so the direction between them means nothing.
    if (is_one_place(std::min(length(v, along[0]), length(v, along[1])))) continue;
    if (!on_surface(along[0]) || !on_surface(along[1]) || turn > kCornerTurn) corners.push_back(v);
  }
  for (Index c = 0; c < mesh_.cells(); ++c) {
    const Cell& cell = mesh_.corners(c);
    if (!is_triangle(cell) && errors_.leads_outside(cell[0], cell[1], kOutsideTolerances * options_.tolerance))
      corners.insert(corners.end(), {cell[0], cell[1]});
  }
  for (const Index v : corners) mesh_.pin(v);
}

std::vector<Index> Remesher::cells_at_edge(Index a, Index b) const {
  std::vector<Index> cells;
  for (const Index c : mesh_.cells_at(a)) {
    const Cell& cell = mesh_.corners(c);
    if (std::find(cell.begin(), cell.end(), b) != cell.end()) cells.push_back(c);
  }
  return cells;
}

// The ball in the middle of an edge: an exact ball, unless that is too far from the middle.
ExactBall Remesher::middle(Index a, Index b) {
  const Point straight = 0.5 * (mesh_.center(a) + mesh_.center(b));
  if (on_surface(a) && on_surface(b)) {
    ClosestPoint place = ExactBall::nowhere();
    if (sharp_.nearest(straight, 0.5 * length(a, b), place)) return ball_on_edge(place);
  }
  const ExactBall exact = solver_.between(mesh_.ball(a), mesh_.ball(b), 0.5);
  const bool near = (exact.center - straight).norm() <= kMaxMidballShift * length(a, b);
  return (near && surface_.inside(exact.center)) || !surface_.inside(straight) ? exact : solver_.at(straight);
}

// Keeps a change; vertices near it may move again.
void Remesher::keep(MeshChange& change, std::span<const Index> made) {
  change.keep();
  cover_.settle();
  for (const Index c : made) {
    for (const Index v : mesh_.corners(c)) active_[v] = 1;
  }
}

}  // namespace orchard::detail
