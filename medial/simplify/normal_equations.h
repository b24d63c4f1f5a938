#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "contractible_mesh.h"

namespace orchard::detail {

// The normal equations of a least-squares problem whose unknowns are the balls of a mesh: a symmetric matrix of 4 x 4
// blocks, one for each living vertex and for each pair of them that an edge joins.
class NormalEquations {
 public:
  explicit NormalEquations(const ContractibleMesh& mesh);

  void clear();
  // Adds weights[i] * weights[j] * block to the matrix for all pairs of corners, and weights[i] * side to the right
  // side. Corners with weight 0 are left out; the others must be a cell of the mesh.
  void add(const std::array<Index, 3>& corners, const std::array<double, 3>& weights, const Eigen::Matrix4d& block,
           const Eigen::Vector4d& side);
  // add_to_vector() adds weights[i] * part at each corner to a vector g over all balls, which starts at 0. add_square()
  // adds factor * g g^T to the matrix and factor * value * g to the right side.
  void add_to_vector(const std::array<Index, 3>& corners, const std::array<double, 3>& weights, const Ball4& part);
  void add_square(double factor, double value);
  // Solves (matrix + damping) * x = right side by conjugate gradients. The damping of each unknown is `damping` times
  // the sum of its entry on the diagonal and the mean of all these. Radii that are held do not change. The result has
  // an entry for every vertex number; it is 0 for vertices that are not alive.
  std::vector<Ball4> solve(double damping, const std::vector<std::uint8_t>& radius_held) const;
  // The right side at a vertex.
  const Ball4& side(Index vertex) const { return side_[number_[vertex]]; }

 private:
  Index entry(Index row, Index column) const;

  std::vector<Index> number_, vertices_;  // of the living vertices: number of a vertex, vertex of a number
  std::vector<Index> offsets_, columns_;  // of the rows of the matrix; columns are ascending
  std::vector<Eigen::Matrix4d> blocks_;
  std::vector<Ball4> side_;
  std::vector<Ball4> vector_;  // g, with its factor
  double factor_ = 0;
};

}  // namespace orchard::detail
