#include <algorithm>
#include <cmath>

#include "intersections.h"

namespace orchard::broad_phase_methods::detail {

Face face_of(const SpaceTimeBound& bound, std::uint32_t body, std::size_t axis, bool upper, BoundShape shape) noexcept {
  const bool quadratic = shape == BoundShape::quadratic;
  const double sign = upper ? 1 : -1;
  return {bound.center[axis] + sign * bound.size,
          bound.velocity[axis] + sign * (quadratic ? bound.growth : bound.slope), quadratic ? sign * bound.bend : 0,
          body, upper};
}

// When the curve below overtakes the one above. For a pair of curves and an order there is at most one such time, so a
// crossing is remembered by its pair and order, never by comparing times (4.2.3).
void Sweep::expect(std::uint32_t below, std::uint32_t above) {
  const Face &a = curves_[below], &b = curves_[above];
  const double c = b.constant - a.constant, h = b.slope - a.slope, q = b.bend - a.bend;
  const bool first_order = below < above;  // as at the start: c >= 0
  double time;
  if (q == 0) {
    if (!first_order || !(h < 0)) return;
    time = c / -h;
  } else {
    // The root at which c + h t + q t^2 turns negative; with q > 0 the smaller one, which has to lie after the start.
    const double discriminant = h * h - 4 * q * c;
    if (!(discriminant > 0) || (q > 0 && (!first_order || !(h < 0)))) return;
    const double root = std::sqrt(discriminant);
    time = h < 0 ? 2 * c / (root - h) : (-h - root) / (2 * q);
    if (crossed_.contains(below, above)) return;
  }
  if (!(time <= end_)) return;
  queue_.push_back({time, below, above});
  std::push_heap(queue_.begin(), queue_.end(), [](const Crossing& x, const Crossing& y) { return x.time > y.time; });
}

void Sweep::run(Search& search, std::size_t axis, std::span<const Face> faces, double begin, double end) {
  curves_.assign(faces.begin(), faces.end());
  for (Face& face : curves_) {
    face.constant = face.at(begin);
    face.slope += 2 * begin * face.bend;
  }
  std::sort(curves_.begin(), curves_.end(), [](const Face& a, const Face& b) {
    if (a.constant != b.constant) return a.constant < b.constant;
    if (a.slope != b.slope) return a.slope < b.slope;
    if (a.bend != b.bend) return a.bend < b.bend;
    return a.body != b.body ? a.body < b.body : a.upper < b.upper;
  });
  const auto count = static_cast<std::uint32_t>(curves_.size());
  order_.resize(count);
  place_.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) order_[i] = place_[i] = i;
  queue_.clear();
  crossed_.clear();
  end_ = end - begin;
  for (std::uint32_t i = 0; i + 1 < count; ++i) expect(i, i + 1);

  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), [](const Crossing& x, const Crossing& y) { return x.time > y.time; });
    const auto [time, below, above] = queue_.back();
    queue_.pop_back();
    if (begin + time > search.limit()) return;
    const std::uint32_t place = place_[below];
    // Rounding can bring a third curve between them; once it is gone the crossing is expected again.
    if (place + 1 >= count || order_[place + 1] != above) continue;
    const Face &a = curves_[below], &b = curves_[above];
    if (a.bend != b.bend && !crossed_.insert(below, above)) continue;
    order_[place] = above, order_[place + 1] = below;
    place_[above] = place, place_[below] = place + 1;
    ++search.counts.crossings;
    if (a.upper && !b.upper && a.body != b.body) search.faces_meet(a.body, b.body, axis, begin + std::max(0.0, time));
    if (place > 0) expect(order_[place - 1], above);
    if (place + 2 < count) expect(below, order_[place + 2]);
    if (a.bend != b.bend) expect(above, below);
  }
}

std::size_t Sweep::memory_bytes() const noexcept {
  return curves_.capacity() * sizeof(Face) + (order_.capacity() + place_.capacity()) * sizeof(std::uint32_t) +
         queue_.capacity() * sizeof(Crossing) + crossed_.memory_bytes();
}

}  // namespace orchard::broad_phase_methods::detail
