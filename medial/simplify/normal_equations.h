#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "contractible_mesh.h"

namespace orchard::detail {

// The normal equations of a least-squares problem in the balls of a mesh: a symmetric matrix of 4 x 4 blocks, for
// living vertices and for pairs of them that an edge joins.
class NormalEquations {
 public:
  explicit NormalEquations(const ContractibleMesh& mesh);

  void clear();
  // Adds weights[i] * weights[j] * block for all pairs of corners, and weights[i] * side. Corners with weight 0 are
  // left out; the others are a cell of the mesh.
  void add(const std::array<Index, 3>& corners, const std::array<double, 3>& weights, const Eigen::Matrix4d& block,
           const Eigen::Vector4d& side);
  // Adds factor * g g^T for a vector g over all balls, which starts at 0: add_to_vector() adds weights[i] * part to it
  // at each corner. And factor * value * g to the side.
  void add_to_vector(const std::array<Index, 3>& corners, const std::array<double, 3>& weights, const Ball4& part);
  void add_square(double factor, double value);
  // (matrix + damping) * x = side by conjugate gradients. The damping of each unknown is `damping` times its entry on
  // the diagonal and the mean one. Radii that are held do not change. For all numbers of vertices; others get 0.
  std::vector<Ball4> solve(double damping, const std::vector<std::uint8_t>& radius_held) const;
  // The side, for a vertex.
  const Ball4& side(Index vertex) const { return side_[number_[vertex]]; }

 private:
  Index entry(Index row, Index column) const;

  std::vector<Index> number_, vertices_;  // of the living
  std::vector<Index> offsets_, columns_;  // of rows; ascending
  std::vector<Eigen::Matrix4d> blocks_;
  std::vector<Ball4> side_;
  std::vector<Ball4> vector_;  // g, with what it counts
  double factor_ = 0;
};

}  // namespace orchard::detail
