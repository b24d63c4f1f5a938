#include "box_lattice.h"

#include <algorithm>
#include <cmath>

#include "../vector_support.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMiddle = 1073741824.0;     // the origin's quantum, 2^30
constexpr double kFarQuanta = 1073741824.0;  // beyond, a box is everything: rounding is no longer under control
constexpr double kRoundingQuanta = 0x1p-8;   // covers some roundings of numbers below 2^31

}  // namespace

Lattice::Lattice(const Vec3& origin, double cell_size) noexcept : origin_(origin), per_length_(kQuanta / cell_size) {
  double size = 0;
  for (const double x : origin) size = std::max(size, std::fabs(x));
  margin_ = kRoundingQuanta + 8 * kMotionSlack * (size * per_length_ + kFarQuanta);
}

// The centre's offset along an axis is at most v t + spread(t), which is convex: largest at an end. Likewise below.
ORCHARD_INLINE void Lattice::make_boxes(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept {
  std::array<double, kBlock> spread, radius, far;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double t = motions.duration[i];
    spread[i] = t * (motions.drift[i] + t * motions.acceleration[i] / 2) * per_length_;
    radius[i] = motions.radius[i] * per_length_ + margin_;
    far[i] = std::max(spread[i], radius[i]);
  }
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const double begin = (motions.position[d][i] - origin_[d]) * per_length_;
      const double way = motions.velocity[d][i] * motions.duration[i] * per_length_;
      far[i] = std::max(far[i], std::max(std::fabs(begin), std::fabs(way)));
      const double lower = kMiddle + (begin + std::min(0.0, way - spread[i]) - radius[i]);
      const double upper = kMiddle + (begin + std::max(0.0, way + spread[i]) + radius[i]);
      const auto quantum = [](double q) ORCHARD_INLINE_LAMBDA {
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::min(std::max(q, 0.0), double{kLastQuantum})));
      };
      boxes.lower[d][i] = quantum(lower);
      boxes.upper[d][i] = quantum(upper);
    }
  }
  for (std::size_t i = 0; i < lanes; ++i) {
    if (far[i] < kFarQuanta) [[likely]]
      continue;
    for (std::size_t d = 0; d < 3; ++d) boxes.lower[d][i] = 0, boxes.upper[d][i] = kLastQuantum;
  }
}

void Lattice::boxes_plain(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept {
  make_boxes(motions, lanes, boxes);
}
ORCHARD_PER_MACHINE void Lattice::boxes_vectors(const MotionBlock& motions, std::size_t lanes,
                                                BoxBlock& boxes) const noexcept {
  make_boxes(motions, lanes, boxes);
}

void Lattice::boxes(MotionBlock& motions, std::size_t count, BoxBlock& boxes, bool vectors) const noexcept {
  motions.fill_up(count);
  vectors ? boxes_vectors(motions, lanes_for(count), boxes) : boxes_plain(motions, lanes_for(count), boxes);
}

}  // namespace orchard::runtime::detail
