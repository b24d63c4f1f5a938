#pragma once
#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "fit.h"

namespace orchard::detail {

// Samples, and their feet on a mesh that changes by contractions: those at each vertex.
class FeetByVertex {
 public:
  // `feet` are of these samples, on cells of the mesh; they follow it.
  FeetByVertex(const ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet);

  const FitSample& sample(Index i) const { return samples_[i]; }
  std::span<const FitSample> samples() const { return samples_; }
  const Foot& foot(Index sample) const { return feet_.feet[sample]; }
  // Those whose foot's cell has the vertex as a corner, ascending; by no weight, too: it may become another.
  const std::vector<Index>& at(Index vertex) const { return at_[vertex]; }
  std::vector<Index> at_either(Index a, Index b) const;

  void set_foot(Index sample, const Foot& foot);
  // After the mesh contracted a and b: the feet of these, all that were at either, on cells that are there.
  void contract(Index a, Index b, std::span<const Index> samples);

 private:
  void enter(Index sample);
  void leave(Index sample);

  const ContractibleMesh& mesh_;
  const std::span<const FitSample> samples_;
  Assignment& feet_;
  std::vector<std::vector<Index>> at_;
};

}  // namespace orchard::detail
