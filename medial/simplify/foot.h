#pragma once
#include <array>
#include <span>
#include <vector>

#include "../quality/support_tree.h"
#include "cell_geometry.h"

namespace orchard::detail {

// The ball of a medial mesh that comes nearest to a point: the corners of its cell, and what it takes of each.
struct Foot {
  std::array<Index, 3> corners{kNone, kNone, kNone};  // smaller cells repeat the first
  std::array<double, 3> weights{1, 0, 0};             // of corners that are repeated: 0
  double value = 0;                                   // |point - centre| - radius

  // Of a point so deep in the solid: what is missing to that depth.
  Foot below(double depth) const { return {corners, weights, value + depth}; }
  Ball4 ball(const ContractibleMesh& mesh) const {
    return weights[0] * mesh.ball(corners[0]) + weights[1] * mesh.ball(corners[1]) + weights[2] * mesh.ball(corners[2]);
  }
};

// The best ball of one cell.
Foot foot_on(const ContractibleMesh& mesh, const std::array<Index, 3>& corners, const Point& query);

// Like FootWalker::walk(), for meshes whose cells change.
Foot walk_to_foot(const ContractibleMesh& mesh, const Point& query, const Foot& start);

// The maximal cells of a mesh, in its order.
std::vector<CellBalls> balls_of_cells(const ContractibleMesh& mesh);

// Finds feet near where they were while the mesh keeps its cells.
class FootWalker {
 public:
  explicit FootWalker(const ContractibleMesh& mesh);

  // After balls of the mesh moved.
  void follow_mesh();

  // The best ball of the cell of `start` if it is inside a triangle; else of the cells around its heaviest corner, and
  // so on from there while it gets better. Its corners are a cell of the mesh. Many times as fast as a search of all,
  // and mostly the same.
  Foot walk(const Point& query, const Foot& start) const;

 private:
  Foot foot_of(const Point& query, const Foot& start) const;

  const ContractibleMesh& mesh_;
  std::vector<CellBalls> cells_;
  Rows at_;  // numbers of cells at each vertex
};

// Those of these balls that stick out of the mesh's, as far as these are found at once, by more than `depth`: most are
// inside of one. Fastest where balls follow each other along the axis. Parallel, deterministic.
std::vector<Sphere> balls_beyond(const ContractibleMesh& mesh, std::span<const Sphere> balls, double depth);

// Finds feet while the mesh stays as it is.
class FootFinder {
 public:
  explicit FootFinder(const ContractibleMesh& mesh);

  // `guess`, if its corners are a cell of the mesh, is where to look first: that saves most of the time. What is found
  // instead, if anything, is nearer by more than `slack`, which saves more.
  Foot find(const Point& query, const Foot* guess = nullptr, double slack = 0) const;

 private:
  const ContractibleMesh& mesh_;
  std::vector<CellBalls> cells_;
  SupportTree tree_;
};

}  // namespace orchard::detail
