#pragma once
#include <array>
#include <span>
#include <vector>

#include "../quality/support_tree.h"
#include "cell_geometry.h"

namespace orchard::detail {

// The ball of a medial mesh whose surface comes nearest to a point (its value is least): the corners of its cell, and
// their weights in the ball.
struct Foot {
  std::array<Index, 3> corners{kNone, kNone, kNone};  // smaller cells repeat the first
  std::array<double, 3> weights{1, 0, 0};             // of corners that are repeated: 0
  double value = 0;                                   // |point - centre| - radius

  // The foot of a point that lies `depth` below the surface: its value is 0 where the ball just reaches the surface.
  Foot below(double depth) const { return {corners, weights, value + depth}; }
  Ball4 ball(const ContractibleMesh& mesh) const {
    return weights[0] * mesh.ball(corners[0]) + weights[1] * mesh.ball(corners[1]) + weights[2] * mesh.ball(corners[2]);
  }
};

// The foot of a point among the balls of one cell.
Foot foot_on(const ContractibleMesh& mesh, const std::array<Index, 3>& corners, const Point& query);

// Like FootWalker::walk(), for meshes whose cells change.
Foot walk_to_foot(const ContractibleMesh& mesh, const Point& query, const Foot& start);

// The maximal cells of a mesh, in its order.
std::vector<CellBalls> balls_of_cells(const ContractibleMesh& mesh);

// Finds feet near where they were while the mesh keeps its cells.
class FootWalker {
 public:
  explicit FootWalker(const ContractibleMesh& mesh);

  // Must be called after balls of the mesh moved.
  void follow_mesh();

  // Walks from `start`, whose corners are a cell of the mesh: if the best ball of that cell lies inside a triangle, it
  // is the answer; else the cells around its heaviest corner are tried, and so on from the best of them, as long as the
  // value falls. Many times as fast as a search of all cells, and mostly with the same result.
  Foot walk(const Point& query, const Foot& start) const;

 private:
  Foot foot_of(const Point& query, const Foot& start) const;

  const ContractibleMesh& mesh_;
  std::vector<CellBalls> cells_;
  Rows at_;  // numbers of cells at each vertex
};

// Those of `balls` that stick out of the mesh's balls by `depth` or more, by a quick search. It may miss the best ball
// of the mesh, so that a few of the result stick out by less. Fastest where consecutive balls are neighbours on the
// axis. Parallel, deterministic.
std::vector<Sphere> balls_beyond(const ContractibleMesh& mesh, std::span<const Sphere> balls, double depth);

// Finds the feet of points by a search of all cells, while the mesh does not change.
class FootFinder {
 public:
  explicit FootFinder(const ContractibleMesh& mesh);

  // `guess` is where to look first, if its corners are a cell of the mesh: that saves most of the time. A foot that is
  // better than the guess by at most `slack` may be missed, which saves more time.
  Foot find(const Point& query, const Foot* guess = nullptr, double slack = 0) const;

 private:
  const ContractibleMesh& mesh_;
  std::vector<CellBalls> cells_;
  SupportTree tree_;
};

}  // namespace orchard::detail
