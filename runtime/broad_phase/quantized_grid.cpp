#include "broad_phase/quantized_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "broad_phase/four_motions.h"
#include "broad_phase/horn.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMiddle = 0x1p30 + 0.5 * kQuanta;  // the origin's quantum: in the middle of a cell
constexpr double kRoundingQuanta = 0x1p-8;          // covers some roundings of numbers below 2^32

// Some bodies' motions by coordinate.
template <typename Numbers>
struct MotionColumns {
  std::array<Numbers, 3> position, velocity;
  Numbers radius, acceleration, drift;
  Numbers rest;  // sums of the squares of drifts and half-spaces, of all these bodies, in any order
};

// How many bodies are worked on together, and their numbers; row(i) points to the i-th one's motion.
struct PlainMotions {
  static constexpr std::size_t kLanes = 4;
  static constexpr bool kClips = true;  // boxes to the quantized grid; others tell that some do not lie in it
  using Numbers = Several<double, kLanes>;
  using Mask = decltype(Numbers{} < Numbers{});
  using Columns = MotionColumns<Numbers>;
  static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return Numbers::make([&](std::size_t i) { return mask[i] ? a[i] : b[i]; });
  }
  static Numbers min(const Numbers& a, const Numbers& b) noexcept { return choose(b < a, b, a); }
  static Numbers max(const Numbers& a, const Numbers& b) noexcept { return choose(a < b, b, a); }
  static Mask within(const Numbers& first, const Numbers& a, const Numbers& b, const Numbers& last) noexcept {
    return (first <= a) & (b <= last);
  }
  template <typename Row>
  static Columns columns(const Row& row) noexcept {
    const auto column = [&](auto&& of) { return Numbers::make([&](std::size_t i) { return of(*row(i)); }); };
    Columns result{};
    for (std::size_t d = 0; d < 3; ++d) {
      result.position[d] = column([d](const Motion& motion) { return motion.position[d]; });
      result.velocity[d] = column([d](const Motion& motion) { return motion.velocity[d]; });
    }
    result.radius = column([](const Motion& motion) { return motion.radius; });
    result.acceleration = column([](const Motion& motion) { return motion.acceleration; });
    result.drift = column([](const Motion& motion) { return motion.drift; });
    result.rest = column([](const Motion& of) { return of.drift * of.drift + dot(of.half_space, of.half_space); });
    return result;
  }
  static bool all(const Mask& mask) noexcept { return (mask[0] & mask[1] & mask[2] & mask[3]) != 0; }
  static void truncate(const Numbers& a, std::uint32_t* to) noexcept {
    for (std::size_t i = 0; i < kLanes; ++i) to[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(a[i]));
  }
};

#ifdef ORCHARD_VECTORS
struct VectorMotions : VectorDoubles {
  static constexpr std::size_t kLanes = 4;
  static constexpr bool kClips = false;
  using Columns = MotionColumns<Numbers>;
  ORCHARD_INLINE static Mask within(const Numbers& first, const Numbers& a, const Numbers& b,
                                    const Numbers& last) noexcept {
    return (first <= a) & (b <= last);
  }
  template <typename Row>
  ORCHARD_INLINE static Columns columns(const Row& row) noexcept {
    const std::array<Numbers, 4> first = transposed(row, kPositionAndVelocity),
                                 second = transposed(row, kVelocityAndRadius);
    const auto squares = [&](std::size_t i) ORCHARD_INLINE_LAMBDA {
      return at(&row(i)->drift) * at(&row(i)->drift);
    };  // and half-space
    return {{first[0], first[1], first[2]},
            {first[3], second[0], second[1]},
            second[2],
            second[3],
            Numbers{row(0)->drift, row(1)->drift, row(2)->drift, row(3)->drift},
            (squares(0) + squares(1)) + (squares(2) + squares(3))};
  }
  ORCHARD_INLINE static void truncate(const Numbers& a, std::uint32_t* to) noexcept {
    using Integers __attribute__((vector_size(4 * kLanes))) = std::int32_t;
    const Integers integers = __builtin_convertvector(a, Integers);
    std::memcpy(to, &integers, sizeof integers);
  }
};

#endif

}  // namespace

void BoxBlock::store(std::span<const std::uint32_t> places, std::span<PackedAabb> to) const noexcept {
  std::size_t i = 0;
#ifdef ORCHARD_VECTORS
  using Four __attribute__((vector_size(16))) = std::uint32_t;
  const auto at = [&](const std::array<std::uint32_t, kBlock>& from) {
    Four result;
    std::memcpy(&result, &from[i], sizeof result);
    return result;
  };
  const auto put = [&](std::size_t k, const Four& box) {
    static_assert(sizeof(PackedAabb) == sizeof box);
    std::memcpy(&to[places[i + k]], &box, sizeof box);
  };
  for (; i + 4 <= places.size(); i += 4) {
    const Four x = at(lower[0]), y = at(lower[1]), z = at(lower[2]);
    const Four lengths = (at(upper[0]) - x) | (at(upper[1]) - y) << 8 | (at(upper[2]) - z) << 16;
    const Four first = __builtin_shufflevector(x, y, 0, 4, 1, 5), second = __builtin_shufflevector(x, y, 2, 6, 3, 7),
               rest = __builtin_shufflevector(z, lengths, 0, 4, 1, 5),
               more_rest = __builtin_shufflevector(z, lengths, 2, 6, 3, 7);
    put(0, __builtin_shufflevector(first, rest, 0, 1, 4, 5));
    put(1, __builtin_shufflevector(first, rest, 2, 3, 6, 7));
    put(2, __builtin_shufflevector(second, more_rest, 0, 1, 4, 5));
    put(3, __builtin_shufflevector(second, more_rest, 2, 3, 6, 7));
  }
#endif
  for (; i < places.size(); ++i) to[places[i]] = PackedAabb(get(i));
}

QuantizedGrid::QuantizedGrid(const Vec3& origin, const Vec3& velocity, double cell_size, double slack) noexcept
    : first_(origin), velocity_(velocity), per_length_(kQuanta / cell_size), slack_(slack) {
  move_to(0);
}

void QuantizedGrid::move_to(double seconds) noexcept {
  origin_ = first_ + seconds * velocity_;
  double size = 0;
  for (const double x : origin_) size = std::max(size, std::fabs(x));
  margin_ =
      kRoundingQuanta + 8 * kMotionSlack * (size * per_length_ + kLastQuantum) + (slack_ + kMinLength) * per_length_;
}

double QuantizedGrid::quantum(double coordinate, std::size_t axis) const noexcept {
  return kMiddle + (coordinate - origin_[axis]) * per_length_;
}

// What tells whether all motions are valid, put together from those of each few: NaN stays in the sum.
template <typename Kind>
struct QuantizedGrid::Validity {
  using Numbers = typename Kind::Numbers;
  typename Kind::Mask inside;
  Numbers squares = zero();  // of velocities, accelerations and so on
  Numbers least = zero();    // of what must not be negative

  // Inlined without optimisation, too: only its caller may use the instructions of the Kind.
  ORCHARD_INLINE Validity() noexcept : inside(Kind::within(zero(), zero(), zero(), zero())) {}
  ORCHARD_INLINE static Numbers zero() noexcept { return spread<Numbers>(0.0); }
  ORCHARD_INLINE bool all() const noexcept {
    const Numbers largest = spread<Numbers>(kMaxNumber * kMaxNumber);
    return Kind::all(inside & Kind::within(zero(), least, squares, largest));
  }
};

// What is told of them together. Quanta are below 2^31: comparisons may take them for signed numbers, which is faster.
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

// The centre's offset along an axis is at most v t + wide(t), which is convex: largest at an end. Likewise below. A box
// that does not lie within the quantized grid is everything: rounding would no longer be under control.
template <typename Kind, typename Row>
ORCHARD_INLINE void QuantizedGrid::make_some(const Row& row, const double* durations, BoxBlock& boxes,
                                             std::size_t first, Validity<Kind>& valid) const noexcept {
  using Numbers = typename Kind::Numbers;
  const auto all = [](double x) ORCHARD_INLINE_LAMBDA { return spread<Numbers>(x); };
  const typename Kind::Columns of = Kind::columns(row);
  const Numbers time = load<Numbers>(*reinterpret_cast<const std::array<double, Kind::kLanes>*>(durations));
  const Numbers per_length = all(per_length_), zero = all(0), last = all(kLastQuantum);
  const Numbers per_speed = time * per_length, half = time * all(0.5);
  const Numbers wide = per_speed * (of.drift + half * of.acceleration);
  const Numbers radius = of.radius * per_length + all(margin_);
  std::array<Numbers, 3> lower, upper;
  typename Kind::Mask inside = valid.inside;
  for (std::size_t d = 0; d < 3; ++d) {
    const Numbers begin = all(kMiddle) + (of.position[d] - all(origin_[d])) * per_length;
    const Numbers way = (of.velocity[d] - all(velocity_[d])) * per_speed;
    lower[d] = begin + Kind::min(zero, way - wide) - radius;
    upper[d] = begin + Kind::max(zero, way + wide) + radius;
  }
  for (std::size_t d = 0; d < 3; ++d) {
    const auto within = Kind::within(zero, lower[d], upper[d], last);
    inside = d == 0 ? within : inside & within;
  }
  for (std::size_t d = 0; d < 3; ++d) {
    if constexpr (Kind::kClips)
      lower[d] = Kind::choose(inside, lower[d], zero), upper[d] = Kind::choose(inside, upper[d], last);
    Kind::truncate(lower[d], &boxes.lower[d][first]);
    Kind::truncate(upper[d], &boxes.upper[d][first]);
  }
  const auto square = [](const Numbers& x) ORCHARD_INLINE_LAMBDA { return x * x; };
  valid.inside = valid.inside & inside;
  valid.least = Kind::min(Kind::min(valid.least, of.radius), Kind::min(of.acceleration, of.drift));
  valid.squares = valid.squares + ((of.rest + square(of.acceleration)) +
                                   (square(of.velocity[0]) + square(of.velocity[1])) + square(of.velocity[2]));
}

// The last ones with copies of the very last one, or with some before it once more.
template <typename Kind>
ORCHARD_INLINE bool QuantizedGrid::make_all(std::span<const Motion> motions, std::span<const double> durations,
                                            BoxBlock& boxes) const noexcept {
  constexpr std::size_t kLanes = Kind::kLanes;
  Validity<Kind> valid;
  const std::size_t count = std::min(motions.size(), kBlock);
  const auto make = [&](std::size_t first) ORCHARD_INLINE_LAMBDA {
    const Motion* const from = &motions[first];
    make_some<Kind>([=](std::size_t i) ORCHARD_INLINE_LAMBDA { return from + i; }, &durations[first], boxes, first,
                    valid);
  };
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) make(i);
  if (i < count && count >= kLanes) make(count - kLanes);
  if (count > 0 && count < kLanes) {
    std::array<double, kLanes> some;
    for (std::size_t k = 0; k < kLanes; ++k) some[k] = durations[std::min(k, count - 1)];
    const auto row = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return &motions[std::min(k, count - 1)]; };
    make_some<Kind>(row, some.data(), boxes, 0, valid);
  }
  if constexpr (!Kind::kClips) {
    if (!Kind::all(valid.inside)) return make_all<PlainMotions>(motions, durations, boxes);  // which clips
  }
  count == kBlock ? tell_extent(boxes, kBlock) : tell_extent(boxes, count);
  return valid.all();
}

bool QuantizedGrid::boxes(std::span<const Motion> motions, std::span<const double> durations,
                          BoxBlock& boxes) const noexcept {
#ifdef ORCHARD_VECTORS
  if (machine() != Machine::portable) {
    bool good = false;
    per_machine([&]() ORCHARD_INLINE_LAMBDA { good = make_all<VectorMotions>(motions, durations, boxes); });
    return good;
  }
#endif
  return make_all<PlainMotions>(motions, durations, boxes);
}

}  // namespace orchard::runtime::detail
