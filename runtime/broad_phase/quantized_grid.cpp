#include "broad_phase/quantized_grid.h"

#include <algorithm>
#include <cmath>

#include "broad_phase/horn.h"
#include "broad_phase/motion_lanes.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMiddle = 0x1p30 + 0.5 * kQuanta;  // the origin's quantum: in the middle of a cell
constexpr double kRoundingQuanta = 0x1p-8;          // covers some rounding errors of numbers below 2^32

}  // namespace

void BoxBlock::store(std::span<const std::uint32_t> places, std::span<PackedAabb> to) const noexcept {
  std::size_t i = 0;
#ifdef ORCHARD_VECTORS  // four boxes at a time, which are transposed
  using Four __attribute__((vector_size(16))) = std::uint32_t;
  for (; i + 4 <= places.size(); i += 4) {
    const auto at = [&](const auto& row) {
      Four result;
      std::memcpy(&result, &row[i], sizeof result);
      return result;
    };
    const Four x = at(lower[0]), y = at(lower[1]), z = at(lower[2]);
    const Four lengths = (at(upper[0]) - x) | (at(upper[1]) - y) << 8 | (at(upper[2]) - z) << 16;
    const Four xy[2] = {__builtin_shufflevector(x, y, 0, 4, 1, 5), __builtin_shufflevector(x, y, 2, 6, 3, 7)};
    const Four rest[2] = {__builtin_shufflevector(z, lengths, 0, 4, 1, 5),
                          __builtin_shufflevector(z, lengths, 2, 6, 3, 7)};
    for (std::size_t k = 0; k < 2; ++k) {
      const Four even = __builtin_shufflevector(xy[k], rest[k], 0, 1, 4, 5),
                 odd = __builtin_shufflevector(xy[k], rest[k], 2, 3, 6, 7);
      std::memcpy(&to[places[i + 2 * k]], &even, sizeof even);
      std::memcpy(&to[places[i + 2 * k + 1]], &odd, sizeof odd);
    }
  }
#endif
  for (; i < places.size(); ++i) to[places[i]] = PackedAabb(get(i));
}

QuantizedGrid::QuantizedGrid(const Vec3& origin, const Vec3& velocity, double cell_size, double slack,
                             const Clock& clock, Step now) noexcept
    : first_(origin),
      velocity_(velocity),
      per_length_(kQuanta / cell_size),
      time_step_(clock.time_step),
      made_at_(now),
      slack_(slack) {
  move_to(now);
}

QuantizedGrid QuantizedGrid::at(Step now) const noexcept {
  QuantizedGrid grid = *this;
  grid.move_to(now);
  return grid;
}

void QuantizedGrid::move_to(Step now) noexcept {
  origin_ = first_ + (static_cast<double>(now - made_at_) * time_step_) * velocity_;
  double size = 0;
  for (const double x : origin_) size = std::max(size, std::fabs(x));
  margin_ =
      kRoundingQuanta + 8 * kMotionSlack * (size * per_length_ + kLastQuantum) + (slack_ + kMinLength) * per_length_;
}

double QuantizedGrid::quantum(double coordinate, std::size_t axis) const noexcept {
  return kMiddle + (coordinate - origin_[axis]) * per_length_;
}

// Sets BoxBlock::around and more_cells. Quanta are below 2^31, so they can be compared as signed numbers, which is
// faster.
ORCHARD_INLINE void tell_extent(BoxBlock& boxes, std::size_t count) noexcept {
  std::uint32_t more_cells = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    auto least = static_cast<std::int32_t>(kLastQuantum);
    std::int32_t most = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t lower = boxes.lower[d][i], upper = boxes.upper[d][i];
      least = std::min(least, static_cast<std::int32_t>(lower));
      most = std::max(most, static_cast<std::int32_t>(upper));
      more_cells |= (upper >> kQuantumBits) - (lower >> kQuantumBits);
    }
    boxes.around.lower[d] = static_cast<std::uint32_t>(least);
    boxes.around.upper[d] = static_cast<std::uint32_t>(most);
  }
  boxes.more_cells = more_cells;
}

// Makes the boxes of as many bodies as the kind has numbers. Along an axis, the offset of the centre is at most v t +
// wide(t), which is convex and so largest at an end of the duration. The same holds for the least offset. A box that
// does not lie within the quantized grid becomes the whole grid, because rounding would no longer be bounded, but
// only if one body is processed at a time. The result is all set if all boxes lie within the grid and all motions are
// valid, as by are_valid().
template <typename Kind, typename Row>
ORCHARD_INLINE typename Kind::Mask QuantizedGrid::make_some(const Row& row, const double* durations, BoxBlock& boxes,
                                                            std::size_t first) const noexcept {
  using Numbers = typename Kind::Numbers;
  const auto all = [](double x) ORCHARD_INLINE_LAMBDA { return all_of<Kind>(x); };
  const MotionLanes<Numbers> of = Kind::motions(row);
  const Numbers time = load_lanes<Kind>(durations);
  const Numbers per_length = all(per_length_), zero = all(0), last = all(kLastQuantum);
  const Numbers per_speed = time * per_length, half = time * all(0.5);
  const Numbers wide = per_speed * (of.drift + half * of.acceleration);
  const Numbers radius = of.radius * per_length + all(margin_);
  std::array<Numbers, 3> lower, upper;
  typename Kind::Mask inside = zero <= zero;
  for (std::size_t d = 0; d < 3; ++d) {
    const Numbers begin = all(kMiddle) + (of.position[d] - all(origin_[d])) * per_length;
    const Numbers way = (of.velocity[d] - all(velocity_[d])) * per_speed;
    lower[d] = begin + least<Kind>(zero, way - wide) - radius;
    upper[d] = begin + most<Kind>(zero, way + wide) + radius;
    inside = both(inside, both(zero <= lower[d], upper[d] <= last));
  }
  for (std::size_t d = 0; d < 3; ++d) {
    if constexpr (Kind::kLanes == 1) {
      lower[d] = Kind::choose(inside, lower[d], zero);
      upper[d] = Kind::choose(inside, upper[d], last);
    }
    Kind::truncate(lower[d], &boxes.lower[d][first]);
    Kind::truncate(upper[d], &boxes.upper[d][first]);
  }
  return inside & are_valid<Kind>(of);
}

// The last vector is filled up with copies of the last body.
template <typename Kind>
ORCHARD_INLINE bool QuantizedGrid::make_all(std::span<const Motion> motions, std::span<const double> durations,
                                            BoxBlock& boxes) const noexcept {
  constexpr std::size_t kLanes = Kind::kLanes;
  const std::size_t count = std::min(motions.size(), kBlock), whole = count - count % kLanes;
  typename Kind::Mask good = all_of<Kind>(0) <= all_of<Kind>(0);
  for (std::size_t i = 0; i < whole; i += kLanes) {
    const Motion* const from = &motions[i];
    good =
        good & make_some<Kind>([=](std::size_t k) ORCHARD_INLINE_LAMBDA { return from + k; }, &durations[i], boxes, i);
  }
  if (whole < count) {
    std::array<double, kLanes> some;
    for (std::size_t k = 0; k < kLanes; ++k) some[k] = durations[std::min(whole + k, count - 1)];
    const auto row = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return &motions[std::min(whole + k, count - 1)]; };
    good = good & make_some<Kind>(row, some.data(), boxes, whole);
  }
  if constexpr (kLanes > 1) {
    if (!Kind::all(good)) return make_all<OneDouble>(motions, durations, boxes);
  }
  count == kBlock ? tell_extent(boxes, kBlock) : tell_extent(boxes, count);
  return Kind::all(good);
}

bool QuantizedGrid::boxes(std::span<const Motion> motions, std::span<const double> durations,
                          BoxBlock& boxes) const noexcept {
  bool good = false;
  with_best_lanes([&]<typename Kind>() ORCHARD_INLINE_LAMBDA { good = make_all<Kind>(motions, durations, boxes); });
  return good;
}

}  // namespace orchard::runtime::detail
