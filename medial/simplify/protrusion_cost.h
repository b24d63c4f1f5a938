#pragma once
#include <vector>

#include "protrusions.h"

namespace orchard::detail {

// As small distances count in the costs of contractions: hardly at all beside the largest.
inline double fourth(double value) {
  const double square = value * value;
  return square * square;
}

// What contractions of edges add to what protrudes.
class ProtrusionCost {
 public:
  // What protrudes no farther than `negligible` counts as nothing.
  ProtrusionCost(const Surface& surface, const ContractibleMesh& mesh, const LookOptions& look, double negligible);

  // The sum of the fourth powers around an edge, how much larger it gets by contracting it to this ball.
  double added(Index a, Index b, const Ball4& ball);

 private:
  double value(const Protrusion& place, const Ball4& ball);
  InsideBall& known_at(const Protrusion& place, const Point& center);

  const Surface& surface_;
  const ContractibleMesh& mesh_;
  const LookOptions look_;
  const double negligible_;
  std::vector<InsideBall> inside_;  // for each vertex
};

}  // namespace orchard::detail
