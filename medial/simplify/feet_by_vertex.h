#pragma once
#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "fit.h"

namespace orchard::detail {

// For a mesh that changes by contractions: the samples whose feet are at each vertex.
class FeetByVertex {
 public:
  // `feet` are the feet of these samples, on cells of the mesh. They are updated with the mesh.
  FeetByVertex(const ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet);

  const FitSample& sample(Index i) const { return samples_[i]; }
  std::span<const FitSample> samples() const { return samples_; }
  const Foot& foot(Index sample) const { return feet_.feet[sample]; }
  // The samples whose foot's cell has the vertex as a corner, ascending; even if its weight is 0, since that may
  // change.
  const std::vector<Index>& at(Index vertex) const { return at_[vertex]; }
  std::vector<Index> at_either(Index a, Index b) const;

  void set_foot(Index sample, const Foot& foot);
  // To be called after the mesh contracted a and b. `samples` are all samples at either of them: their feet are put on
  // cells that exist.
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
