#include "downhill.h"

#include <algorithm>

namespace orchard::detail {

ClosestPoint Downhill::descend(const Point& from, ClosestPoint place) {
  constexpr int kMaxWalk = 1000;  // triangles: only a guard, since every step comes nearer
  place.distance = (place.position - from).norm();
  measured_.clear();
  for (int step = 0; step < kMaxWalk; ++step) {
    surface_.triangles_at(place.triangle, place.feature, around_);
    ClosestPoint best = place;
    for (const Index next : around_) {
      // Triangles that were measured before are not nearer than the present place.
      if (std::find(measured_.begin(), measured_.end(), next) != measured_.end()) continue;
      const auto [a, b, c] = surface_.corners(next);
      ClosestPoint found = closest_point_of_triangle(from, a, b, c);
      found.triangle = next;
      if (found.distance < best.distance) best = found;
    }
    if (!(best.distance < place.distance)) break;
    place = best;
    if (place.feature == Feature::face) break;  // no other triangle is around it
    measured_.swap(around_);
  }
  return place;
}

}  // namespace orchard::detail
