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

namespace orchard::detail {
namespace {

constexpr double kShareAbove = 0.02;        // of what was found: not searched for more
constexpr int kMaxLevels = 100;             // of halving: then a cell is as small as rounding
constexpr std::size_t kFewTriangles = 500;  // of a surface that may all be asked
constexpr double kSmall = 0.1;              // of the distance to the surface: the reach of cells that ask others
constexpr std::size_t kBlock = 64;          // cells that one task looks at
constexpr double kRounding = 1e-12;         // of the coordinates: more than a bound is off by

// Balls interpolated linearly on up to three; edges and vertices repeat their last.
struct Cell {
  std::array<Sphere, 3> balls;
  double bound = std::numeric_limits<double>::infinity();
};

std::vector<Cell> cells_of(const MedialMesh& mesh) {
  const CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  std::vector<Cell> cells;
  const auto add = [&](Index a, Index b, Index c) {
    Cell cell;
    const std::array<Index, 3> corners{a, b, c};
    for (std::size_t k = 0; k < 3; ++k) cell.balls[k] = {mesh.centers[corners[k]], mesh.radii[corners[k]]};
    cells.push_back(cell);
  };
  for (const auto& [a, b, c] : mesh.triangles) add(a, b, c);
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
  return {Cell{{a, middle, c}, cell.bound}, Cell{{middle, b, c}, cell.bound}};
}

class ProtrusionSearch {
 public:
  ProtrusionSearch(const Surface& surface, double known, double accuracy, Index max_cells)
      : surface_(surface), accuracy_(accuracy), max_cells_(max_cells) {
    found_.max = known;
    const Box& box = surface.bounding_box();
    rounding_ = kRounding * (box.min().norm() + box.max().norm());
  }

  SearchedMax run(std::vector<Cell> cells) {
    double open = 0;  // the largest bound of what is not halved any more
    std::size_t looked_at = 0;
    for (int level = 0; level < kMaxLevels && !cells.empty(); ++level) {
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
    std::vector<SearchedMax> results((cells.size() + kBlock - 1) / kBlock, found_);
    tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t block) {
      const std::size_t end = std::min(cells.size(), (block + 1) * kBlock);
      std::vector<Index> near;
      for (std::size_t i = block * kBlock; i < end; ++i)
        cells[i].bound = std::min(cells[i].bound, bound_of(cells[i], before, near, results[block]));
    });
    for (const SearchedMax& result : results) {
      if (result.max > found_.max) found_ = result;
    }
  }

  // Of r + signed distance over the cell. The signed distance is 1-Lipschitz; and where all centres are inside, the
  // distance to each triangle is convex, so no less than its tangent at the middle says, which is linear as r is: what
  // that leaves is largest at a corner. Where balls touch flat faces the tangents are exact.
  double bound_of(const Cell& cell, double known, std::vector<Index>& near, SearchedMax& found) const {
    const auto& [a, b, c] = cell.balls;
    const Sphere middle{(a.center + b.center + c.center) / 3, (a.radius + b.radius + c.radius) / 3};
    const double depth = surface_.signed_distance(middle.center);
    double reach = 0, bound = -std::numeric_limits<double>::infinity();
    for (const Sphere& ball : cell.balls) {
      const double length = (ball.center - middle.center).norm();
      reach = std::max(reach, length);
      bound = std::max(bound, depth + length + ball.radius);
    }
    bound += rounding_;
    if (bound <= known) return bound;
    if (depth + middle.radius > found.max) {
      const BallReach attained = reach_of(surface_, middle);
      if (attained.beyond > found.max) found = {attained.beyond, 0, attained.farthest, middle};
    }
    const double share = surface_.mesh().triangles.size() <= kFewTriangles ? 1 : kSmall;
    if (reach > 0 && reach < -share * depth)
      bound = std::min(bound, bound_by_tangents(cell, {middle.center, -depth}, known, near));
    return bound;
  }

  // `inside`: around the middle of the cell, up to the surface. Triangles farther than those that are looked at are the
  // nearest of no centre in the cell, or no ball of it reaches beyond them by more than is known.
  double bound_by_tangents(const Cell& cell, const Sphere& inside, double known, std::vector<Index>& near) const {
    double reach = 0, max_radius = 0;
    for (const Sphere& ball : cell.balls) {
      reach = std::max(reach, (ball.center - inside.center).norm());
      max_radius = std::max(max_radius, ball.radius);
    }
    const double farthest = std::min(inside.radius + 2 * reach, max_radius + reach - known) + rounding_;
    double bound = known;
    if (farthest < inside.radius) return bound;
    surface_.triangles_near({inside.center, farthest}, near);
    for (const Index t : near) {
      const auto [p, q, r] = surface_.corners(t);
      const ClosestPoint closest = closest_point_of_triangle(inside.center, p, q, r);
      const Vector tangent = (inside.center - closest.position) / closest.distance;
      for (const Sphere& ball : cell.balls)
        bound = std::max(bound, ball.radius - closest.distance - tangent.dot(ball.center - inside.center));
    }
    return bound + rounding_;
  }

  const Surface& surface_;
  const double accuracy_;
  const std::size_t max_cells_;  // to look at, all levels together
  double rounding_ = 0;
  SearchedMax found_;
};

}  // namespace

SearchedMax max_protrusion(const Surface& surface, const MedialMesh& mesh, double known, double accuracy,
                           Index max_cells) {
  return ProtrusionSearch(surface, known, accuracy, max_cells).run(cells_of(mesh));
}

}  // namespace orchard::detail
