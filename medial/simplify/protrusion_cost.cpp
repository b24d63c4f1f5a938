#include "protrusion_cost.h"

#include <algorithm>

namespace orchard::detail {

ProtrusionCost::ProtrusionCost(const Surface& surface, const ContractibleMesh& mesh, const LookOptions& look,
                               double negligible)
    : surface_(surface), mesh_(mesh), look_(look), negligible_(negligible), inside_(mesh.size()) {}

double ProtrusionCost::added(Index a, Index b, const Ball4& ball) {
  double before = 0, after = 0;
  for (const Protrusion& place : places_around(mesh_, a, b, look_)) {
    before += fourth(value(place, place.ball(mesh_)));
    Ball4 moved = Ball4::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Index corner = place.corners[k];
      moved += place.weights[k] * (corner == a || corner == b ? ball : mesh_.ball(corner));
    }
    after += fourth(value(place, moved));
  }
  return after - before;
}

double ProtrusionCost::value(const Protrusion& place, const Ball4& ball) {
  Vector outward;
  return protrusion_of(surface_, ball, negligible_, known_at(place, ball.head<3>()), outward);
}

// Returns the known ball for a corner of the place's cell, preferably one that contains the place.
InsideBall& ProtrusionCost::known_at(const Protrusion& place, const Point& center) {
  for (const Index corner : place.corners) {
    if (inside_[corner].holds(center)) return inside_[corner];
  }
  const auto heaviest = std::max_element(place.weights.begin(), place.weights.end()) - place.weights.begin();
  return inside_[place.corners[static_cast<std::size_t>(heaviest)]];
}

}  // namespace orchard::detail
