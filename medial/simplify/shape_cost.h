#pragma once
#include "contractible_mesh.h"

namespace orchard::detail {

// How much worse a medial mesh is made by contractions of edges: the shape of its triangles, and its sheets.
class ShapeCost {
 public:
  explicit ShapeCost(const ContractibleMesh& mesh);

  // The sum of 1 - quality over the triangles, how much larger it gets by contracting an edge to this ball, as a share
  // of the triangles that there were at the beginning. Where both ends lie on borders, seams or curves and the edge
  // does not, the contraction pinches a sheet: that counts as much as some triangles without area.
  double added(Index a, Index b, const Ball4& ball) const;

 private:
  static constexpr double kPinch = 2;  // triangles without area

  bool is_inside_sheet(Index a, Index b) const;
  bool is_on_structure(Index vertex) const;

  const ContractibleMesh& mesh_;
  double share_ = 0;  // of one triangle in all at the beginning
};

}  // namespace orchard::detail
