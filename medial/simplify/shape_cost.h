#pragma once
#include "contractible_mesh.h"

namespace orchard::detail {

// By how much contractions of edges make the triangles and sheets of a medial mesh worse.
class ShapeCost {
 public:
  explicit ShapeCost(const ContractibleMesh& mesh);

  // By how much the sum of (1 - quality) over the triangles grows if the edge is contracted to this ball, divided by
  // the number of triangles at the beginning. If both ends lie on borders, seams or curves but the edge does not, the
  // contraction pinches a sheet, which counts as much as kPinch triangles without area.
  double added(Index a, Index b, const Ball4& ball) const;

 private:
  static constexpr double kPinch = 2;  // triangles without area

  bool is_inside_sheet(Index a, Index b) const;
  bool is_on_structure(Index vertex) const;

  const ContractibleMesh& mesh_;
  double share_ = 0;  // share of one triangle among those at the beginning
};

}  // namespace orchard::detail
