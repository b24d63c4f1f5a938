#include "broad_phase/sphere_notes.h"

#include <cmath>

#include "broad_phase/horn.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMaxFloat = 0x1p120;   // numbers below it are finite in float
constexpr double kMinFloat = 0x1p-126;  // below it, floats are rounded by more than their last place

}  // namespace

void SphereNotes::begin(bool wanted, std::size_t slots) {
  if (wanted) {
    grow(spheres_, slots);
  } else {
    spheres_.clear();  // the memory is kept, because the next plan may need it
  }
}

void SphereNotes::note(BodyIndex body, const Motion& m, const QuantizedGrid& quantized_grid, double duration) noexcept {
  constexpr double kOutward = 1 + 1e-6;  // for the rounding errors of this function
  const Vec3 &origin = quantized_grid.origin(), &way = quantized_grid.velocity();
  const auto square = [](double x) { return x * x; };
  const double squares =
      square(m.velocity[0] - way[0]) + square(m.velocity[1] - way[1]) + square(m.velocity[2] - way[2]);
  const double travel = duration * (std::sqrt(squares) + m.drift + duration * m.acceleration / 2);
  const double reach = travel + motion_slack(m, m, duration) + 2 * slack_;
  Sphere& sphere = spheres_[body];
  for (std::size_t d = 0; d < 3; ++d) sphere.center[d] = static_cast<float>(m.position[d] - origin[d]);
  sphere.radius = static_cast<float>(m.radius);
  sphere.reach = static_cast<float>(reach * kOutward + kMinFloat);
}

SphereNotes::Answer SphereNotes::compare(const BodyPair& pair, bool now_only) const noexcept {
  constexpr double kRounding = 0x1p-21;  // relative to `largest`: eight times the rounding of a float
  const Sphere &a = spheres_[pair.a], &b = spheres_[pair.b];
  double squared = 0, largest = double{a.radius} + b.radius;
  for (std::size_t d = 0; d < 3; ++d) {
    const double apart = double{b.center[d]} - a.center[d];
    squared += apart * apart;
    largest += std::fabs(double{a.center[d]}) + std::fabs(double{b.center[d]});
  }
  const double radii = double{a.radius} + b.radius, reach = double{a.reach} + b.reach,
               off = kRounding * largest + kMinFloat;
  if (!(largest < kMaxFloat)) return Answer::unknown;
  const auto below = [&](double length) { return length > 0 && squared < length * length; };
  if (below(radii - off)) return now_only || below(radii - reach - off) ? Answer::touching : Answer::unknown;
  if (below(radii + off)) return Answer::unknown;  // only spheres_touch() can decide
  return now_only || !below(radii + reach + off) ? Answer::apart : Answer::unknown;
}

}  // namespace orchard::runtime::detail
