#include "downhill.h"

namespace orchard::detail {

ClosestPoint Downhill::descend(const Point& from, ClosestPoint place) {
  constexpr int kMaxWalk = 1000;  // triangles; a step always comes nearer, so this is but a guard
  place.distance = (place.position - from).norm();
  for (int step = 0; step < kMaxWalk; ++step) {
    surface_.triangles_at(place.triangle, place.feature, around_);
    ClosestPoint best = place;
    for (const Index next : around_) {
      const auto [a, b, c] = surface_.corners(next);
      ClosestPoint found = closest_point_of_triangle(from, a, b, c);
      found.triangle = next;
      if (found.distance < best.distance) best = found;
    }
    if (!(best.distance < place.distance)) break;
    place = best;
  }
  return place;
}

}  // namespace orchard::detail
