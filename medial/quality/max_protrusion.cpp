#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "../axis/incidence.h"
#include "boundary_reach.h"
#include "quality_parts.h"
#include "search_precision.h"

namespace orchard::detail {
namespace {

constexpr int kMaxHalvingLevels = 100;    // of halving: after these a cell is as small as rounding errors
constexpr std::size_t kCellBlock = 64;    // cells that one task looks at
constexpr std::size_t kMaxHalves = 4096;  // of a single cell: if these do not decide, the cell is taken to protrude

// Balls interpolated linearly on up to three; edges and vertices repeat their last.
struct Cell {
  std::array<Sphere, 3> balls;
  const BallDepth* depth = nullptr;  // depth of the middle ball, if it is known
  std::array<const BallDepth*, 3> corner_depths{};
  double bound = std::numeric_limits<double>::infinity();
};

std::vector<Cell> cells_of(const MedialMesh& mesh, const KnownDepths& known) {
  const bool of_vertices = known.vertices.size() == mesh.size();
  const CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  std::vector<Cell> cells;
  const auto add = [&](Index a, Index b, Index c) {
    Cell cell;
    const std::array<Index, 3> corners{a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
      cell.balls[k] = {mesh.centers[corners[k]], mesh.radii[corners[k]]};
      if (of_vertices) cell.corner_depths[k] = &known.vertices[corners[k]];
    }
    cells.push_back(cell);
  };
  for (const auto& [a, b, c] : mesh.triangles) add(a, b, c);
  if (known.triangles.size() == cells.size()) {
    for (std::size_t t = 0; t < cells.size(); ++t) cells[t].depth = &known.triangles[t];
  }
  for (const Index e : at.bare_edges()) add(mesh.edges[e][0], mesh.edges[e][1], mesh.edges[e][1]);
  for (const Index v : at.lone_vertices()) add(v, v, v);
  return cells;
}

std::array<Cell, 2> halves_of(const Cell& cell) {
  std::size_t longest = 0;
  double max = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Sphere &a = cell.balls[k], &b = cell.balls[(k + 1) % 3];
    const double length = (a.center - b.center).squaredNorm() + (a.radius - b.radius) * (a.radius - b.radius);
    if (length > max) max = length, longest = k;
  }
  const Sphere &a = cell.balls[longest], &b = cell.balls[(longest + 1) % 3], &c = cell.balls[(longest + 2) % 3];
  const Sphere middle{0.5 * (a.center + b.center), 0.5 * (a.radius + b.radius)};
  return {Cell{{a, middle, c}, nullptr, {}, cell.bound}, Cell{{middle, b, c}, nullptr, {}, cell.bound}};
}

// An upper bound on (radius - distance from the surface) over a cell. |x|^2 - distance^2 is a convex function of x. So
// the squared distance at x is at least the squared distances at the corners, interpolated, minus the squared distances
// of the corners from x, interpolated likewise; and the latter is at most a third of the longest side's square.
// Infinity if the distances at the corners are not known or the bound is useless.
struct CornerBound {
  double bound = std::numeric_limits<double>::infinity();
  bool inside = false;  // the balls around the corners prove that all centres are in the solid
};
CornerBound bound_by_corners(const Cell& cell) {
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  double least = kUnknown, over = -kUnknown, side = 0;
  bool inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!cell.corner_depths[k]) return {};
    inside = inside && !cell.corner_depths[k]->outside();
    const double distance = cell.corner_depths[k]->nearest.distance;
    least = std::min(least, distance);
    over = std::max(over, cell.balls[k].radius - distance);
    side = std::max(side, (cell.balls[k].center - cell.balls[(k + 1) % 3].center).squaredNorm());
  }
  const double below = least * least - side / 3;
  if (!(below > 0)) return {};
  return {over + side / 3 / (least + std::sqrt(below)), inside && side < least * least};
}

class ProtrusionSearch {
 public:
  ProtrusionSearch(const Surface& surface, double known, double accuracy, Index max_cells)
      : surface_(surface), accuracy_(accuracy), max_cells_(max_cells) {
    found_.max = known;
    const Box& box = surface.bounding_box();
    rounding_ = search_rounding(box);
  }

  SearchedMax run(std::vector<Cell> cells) {
    double open = 0;  // the largest bound of cells that are not halved any more
    std::size_t looked_at = 0;
    for (int level = 0; level < kMaxHalvingLevels && !cells.empty(); ++level) {
      looked_at += cells.size();
      if (looked_at > max_cells_) break;
      look_at(cells);
      std::vector<Cell> next;
      for (const Cell& cell : cells) {
        if (!(cell.bound > enough())) {
          open = std::max(open, cell.bound);
          continue;
        }
        for (const Cell& half : halves_of(cell)) next.push_back(half);
      }
      cells = std::move(next);
    }
    for (const Cell& cell : cells) open = std::max(open, cell.bound);
    found_.upper = std::max(open, found_.max) + rounding_;
    return found_;
  }

 private:
  double enough() const { return found_.max + std::max(accuracy_, kShareAbove * found_.max); }

  void look_at(std::vector<Cell>& cells) {
    const double before = found_.max;
    std::vector<SearchedMax> results((cells.size() + kCellBlock - 1) / kCellBlock, found_);
    tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t block) {
      const std::size_t end = std::min(cells.size(), (block + 1) * kCellBlock);
      for (std::size_t i = block * kCellBlock; i < end; ++i)
        cells[i].bound = std::min(cells[i].bound, bound_of(cells[i], before, results[block]));
    });
    for (const SearchedMax& result : results) {
      if (result.max > found_.max) found_ = result;
    }
  }

  // An upper bound on (radius + signed distance) over the cell. The signed distance is 1-Lipschitz, which gives one
  // bound. If all centres are inside, there is a better one: the distance to each triangle is convex, so it is at least
  // its tangent at the middle. This tangent and the radius are linear, so the bound is largest at a corner. Where balls
  // touch flat faces, the tangents are exact.
  double bound_of(const Cell& cell, double known, SearchedMax& found) const {
    const CornerBound by_corners = bound_by_corners(cell);
    if (by_corners.inside && by_corners.bound + rounding_ <= known) return by_corners.bound + rounding_;
    const auto& [a, b, c] = cell.balls;
    const Sphere middle{(a.center + b.center + c.center) / 3, (a.radius + b.radius + c.radius) / 3};
    const BallDepth middle_depth = cell.depth ? *cell.depth : depth_of(surface_, middle);
    const double depth = middle_depth.signed_distance;
    double reach = 0, bound = -std::numeric_limits<double>::infinity();
    for (const Sphere& ball : cell.balls) {
      const double length = (ball.center - middle.center).norm();
      reach = std::max(reach, length);
      bound = std::max(bound, depth + length + ball.radius);
    }
    bound += rounding_;
    if (bound <= known) return bound;
    if (depth + middle.radius > found.max) {
      const BallReach attained = reach_of(surface_, middle, middle_depth);
      if (attained.beyond > found.max) found = {attained.beyond, 0, attained.farthest, middle};
    }
    if (reach < -depth) bound = std::min(bound, by_corners.bound + rounding_);
    if (bound <= enough()) return bound;
    if (reach < -depth) bound = std::min(bound, surface_.max_reach(cell.balls, middle.center, known) + rounding_);
    return bound;
  }

  const Surface& surface_;
  const double accuracy_;
  const std::size_t max_cells_;  // the most that are tested, on all levels together
  double rounding_ = 0;
  SearchedMax found_;
};

// The result of depth_of() for a ball in the solid that touches the surface.
BallDepth depth_of_touching(const Sphere& ball) {
  BallDepth depth;
  depth.signed_distance = -ball.radius;
  depth.nearest.distance = ball.radius;
  return depth;
}

}  // namespace

bool may_stick_out(const Surface& surface, const std::array<Sphere, 3>& balls, double limit) {
  std::array<BallDepth, 3> depths;
  Cell cell;
  cell.balls = balls;
  for (std::size_t k = 0; k < 3; ++k) {
    depths[k] = depth_of_touching(balls[k]);
    cell.corner_depths[k] = &depths[k];
  }
  const CornerBound by_corners = bound_by_corners(cell);
  if (by_corners.inside && by_corners.bound <= limit) return false;
  const double known = limit / (1 + 2 * kShareAbove);
  return ProtrusionSearch(surface, known, kShareAbove * known, kMaxHalves).run({cell}).upper > limit;
}

SearchedMax max_protrusion(const Surface& surface, const MedialMesh& mesh, const KnownDepths& depths, double known,
                           double accuracy, Index max_cells) {
  return ProtrusionSearch(surface, known, accuracy, max_cells).run(cells_of(mesh, depths));
}

}  // namespace orchard::detail
