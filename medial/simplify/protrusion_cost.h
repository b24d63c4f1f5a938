#pragma once
#include <vector>

#include "protrusions.h"

namespace orchard::detail {

// Returns the fourth power, with which distances count in the costs of contractions: small ones hardly count beside the
// largest.
inline double fourth(double value) {
  const double square = value * value;
  return square * square;
}

// The increase of protrusions by contractions of edges.
class ProtrusionCost {
 public:
  // Protrusions of at most `negligible` do not count.
  ProtrusionCost(const Surface& surface, const ContractibleMesh& mesh, const LookOptions& look, double negligible);

  // Returns the increase of the sum of the fourth powers of protrusions around an edge if it is contracted to this
  // ball.
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
