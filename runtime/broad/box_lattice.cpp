#include "box_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "../machine.h"
#include "four_motions.h"
#include "horn.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMiddle = 0x1p30 + kQuanta / 2;  // the origin's quantum: in the middle of a cell
constexpr double kRoundingQuanta = 0x1p-8;        // covers some roundings of numbers below 2^32

// Four bodies' motions by coordinate.
template <typename Numbers>
struct MotionColumns {
  std::array<Numbers, 3> position, velocity;
  Numbers radius, acceleration, drift;
  Numbers rest;  // sums of the squares of drifts and half-spaces, of all four bodies, in any order
};

struct PlainDoubles {
  using Numbers = Plain<double, 4>;
  using Mask = Numbers::Mask;
  using Columns = MotionColumns<Numbers>;
  static Numbers choose(const Mask& mask, const Numbers& a, const Numbers& b) noexcept {
    return Numbers::make([&](std::size_t i) { return mask[i] ? a[i] : b[i]; });
  }
  static Columns columns(const Motion* m) noexcept {
    const auto column = [&](auto&& of) { return Numbers::make([&](std::size_t i) { return of(m[i]); }); };
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
    for (std::size_t i = 0; i < 4; ++i) to[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(a[i]));
  }
};

#ifdef ORCHARD_VECTORS
struct VectorMotions : VectorDoubles {
  using Columns = MotionColumns<Numbers>;
  ORCHARD_INLINE static Columns columns(const Motion* m) noexcept {
    const std::array<Numbers, 4> first = transposed(m, kPositionAndVelocity),
                                 second = transposed(m, kVelocityAndRadius);
    const auto squares = [&](std::size_t i)
                             ORCHARD_INLINE_LAMBDA { return at(&m[i].drift) * at(&m[i].drift); };  // and half-space
    return {{first[0], first[1], first[2]},
            {first[3], second[0], second[1]},
            second[2],
            second[3],
            Numbers{m[0].drift, m[1].drift, m[2].drift, m[3].drift},
            (squares(0) + squares(1)) + (squares(2) + squares(3))};
  }
  ORCHARD_INLINE static void truncate(const Numbers& a, std::uint32_t* to) noexcept {
    using Integers __attribute__((vector_size(16))) = std::int32_t;
    const Integers integers = __builtin_convertvector(a, Integers);
    std::memcpy(to, &integers, sizeof integers);
  }
};
#endif

}  // namespace

void BoxBlock::store(std::span<const std::uint32_t> places, std::span<QuantumBox> to) const noexcept {
  std::size_t i = 0;
#ifdef ORCHARD_VECTORS
  using Four __attribute__((vector_size(16))) = std::uint32_t;
  using Two __attribute__((vector_size(16))) = std::uint64_t;
  const auto at = [&](const std::array<std::uint32_t, kBlock>& from) {
    Four result;
    std::memcpy(&result, &from[i], sizeof result);
    return result;
  };
  const auto low_halves = [](const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 0, 4, 1, 5); };
  const auto high_halves = [](const Four& a, const Four& b) { return __builtin_shufflevector(a, b, 2, 6, 3, 7); };
  const auto put = [&](std::size_t k, const Two& first, std::uint64_t last) {
    static_assert(sizeof(QuantumBox) == sizeof first + sizeof last);
    auto* const box = reinterpret_cast<unsigned char*>(&to[places[i + k]]);
    std::memcpy(box, &first, sizeof first);
    std::memcpy(box + sizeof first, &last, sizeof last);
  };
  for (; i + 4 <= places.size(); i += 4) {
    const Four x = at(lower[0]), y = at(lower[1]), z = at(lower[2]), end_x = at(upper[0]), end_y = at(upper[1]),
               end_z = at(upper[2]);
    const Two begins = reinterpret_cast<Two>(low_halves(x, y)), more_begins = reinterpret_cast<Two>(high_halves(x, y)),
              rest = reinterpret_cast<Two>(low_halves(z, end_x)),
              more_rest = reinterpret_cast<Two>(high_halves(z, end_x)),
              ends = reinterpret_cast<Two>(low_halves(end_y, end_z)),
              more_ends = reinterpret_cast<Two>(high_halves(end_y, end_z));
    put(0, __builtin_shufflevector(begins, rest, 0, 2), ends[0]);
    put(1, __builtin_shufflevector(begins, rest, 1, 3), ends[1]);
    put(2, __builtin_shufflevector(more_begins, more_rest, 0, 2), more_ends[0]);
    put(3, __builtin_shufflevector(more_begins, more_rest, 1, 3), more_ends[1]);
  }
#endif
  for (; i < places.size(); ++i) to[places[i]] = get(i);
}

Lattice::Lattice(const Vec3& origin, const Vec3& velocity, double cell_size, double slack) noexcept
    : first_(origin), velocity_(velocity), per_length_(kQuanta / cell_size), slack_(slack) {
  move_to(0);
}

void Lattice::move_to(double seconds) noexcept {
  origin_ = first_ + seconds * velocity_;
  double size = 0;
  for (const double x : origin_) size = std::max(size, std::fabs(x));
  margin_ =
      kRoundingQuanta + 8 * kMotionSlack * (size * per_length_ + kLastQuantum) + (slack_ + kMinLength) * per_length_;
}

double Lattice::quantum(double coordinate, std::size_t axis) const noexcept {
  return kMiddle + (coordinate - origin_[axis]) * per_length_;
}

// The centre's offset along an axis is at most v t + wide(t), which is convex: largest at an end. Likewise below. A box
// that does not lie within the lattice is everything: rounding would no longer be under control.
// What tells whether all motions are valid, put together from those of each four: NaN stays in the sum.
template <typename Kind>
struct Lattice::Validity {
  typename Kind::Mask inside = spread<typename Kind::Numbers>(0.0) <= spread<typename Kind::Numbers>(0.0);
  typename Kind::Numbers squares = spread<typename Kind::Numbers>(0.0);  // of velocities, accelerations and so on
  typename Kind::Numbers least = spread<typename Kind::Numbers>(0.0);    // of what must not be negative

  ORCHARD_INLINE bool all() const noexcept {
    const auto largest = spread<typename Kind::Numbers>(kMaxNumber * kMaxNumber);
    return Kind::all(inside & (squares <= largest) & (spread<typename Kind::Numbers>(0.0) <= least));
  }
};

template <typename Kind>
ORCHARD_INLINE void Lattice::make_four(const Motion* motions, const double* durations, BoxBlock& boxes,
                                       std::size_t first, Validity<Kind>& valid) const noexcept {
  using Numbers = typename Kind::Numbers;
  const auto all = [](double x) ORCHARD_INLINE_LAMBDA { return spread<Numbers>(x); };
  const auto least = [](const Numbers& a, const Numbers& b) ORCHARD_INLINE_LAMBDA { return Kind::choose(b < a, b, a); };
  const auto most = [](const Numbers& a, const Numbers& b) ORCHARD_INLINE_LAMBDA { return Kind::choose(a < b, b, a); };
  const typename Kind::Columns of = Kind::columns(motions);
  const Numbers time = load<Numbers>(*reinterpret_cast<const std::array<double, 4>*>(durations));
  const Numbers per_length = all(per_length_), zero = all(0), last = all(kLastQuantum);
  const Numbers wide = time * (of.drift + time * of.acceleration * all(0.5)) * per_length;
  const Numbers radius = of.radius * per_length + all(margin_);
  std::array<Numbers, 3> lower, upper;
  typename Kind::Mask inside = zero <= zero;
  for (std::size_t d = 0; d < 3; ++d) {
    const Numbers begin = all(kMiddle) + (of.position[d] - all(origin_[d])) * per_length;
    const Numbers way = (of.velocity[d] - all(velocity_[d])) * time * per_length;
    lower[d] = begin + least(zero, way - wide) - radius;
    upper[d] = begin + most(zero, way + wide) + radius;
    inside = inside & (zero <= lower[d]) & (upper[d] <= last);
  }
  for (std::size_t d = 0; d < 3; ++d) {
    Kind::truncate(Kind::choose(inside, lower[d], zero), &boxes.lower[d][first]);
    Kind::truncate(Kind::choose(inside, upper[d], last), &boxes.upper[d][first]);
  }
  const auto square = [](const Numbers& x) ORCHARD_INLINE_LAMBDA { return x * x; };
  valid.inside = valid.inside & inside;
  valid.least = least(least(valid.least, of.radius), least(of.acceleration, of.drift));
  valid.squares = valid.squares + ((of.rest + square(of.acceleration)) +
                                   (square(of.velocity[0]) + square(of.velocity[1])) + square(of.velocity[2]));
}

template <typename Kind>
ORCHARD_INLINE bool Lattice::make_all(std::span<const Motion> motions, std::span<const double> durations,
                                      BoxBlock& boxes) const noexcept {
  std::size_t i = 0;
  Validity<Kind> valid;
  for (; i + 4 <= motions.size(); i += 4) make_four<Kind>(&motions[i], &durations[i], boxes, i, valid);
  if (i == motions.size()) return valid.all();
  std::array<Motion, 4> rest{};
  std::array<double, 4> rest_durations{};
  std::copy(motions.begin() + static_cast<std::ptrdiff_t>(i), motions.end(), rest.begin());
  std::copy_n(durations.begin() + static_cast<std::ptrdiff_t>(i), motions.size() - i, rest_durations.begin());
  for (std::size_t k = motions.size() - i; k < rest.size(); ++k) rest[k].position = origin_;  // nothing there
  make_four<Kind>(rest.data(), rest_durations.data(), boxes, i, valid);
  return valid.all();
}

bool Lattice::boxes_plain(std::span<const Motion> motions, std::span<const double> durations,
                          BoxBlock& boxes) const noexcept {
  return make_all<PlainDoubles>(motions, durations, boxes);
}

#ifdef ORCHARD_VECTORS
bool Lattice::boxes_vectors(std::span<const Motion> motions, std::span<const double> durations,
                            BoxBlock& boxes) const noexcept {
  bool good = false;
  detail::per_machine([&]() ORCHARD_INLINE_LAMBDA { good = make_all<VectorMotions>(motions, durations, boxes); });
  return good;
}
#else
bool Lattice::boxes_vectors(std::span<const Motion> motions, std::span<const double> durations,
                            BoxBlock& boxes) const noexcept {
  return make_all<PlainDoubles>(motions, durations, boxes);
}
#endif

bool Lattice::boxes(std::span<const Motion> motions, std::span<const double> durations, BoxBlock& boxes,
                    bool vectors) const noexcept {
  return vectors ? boxes_vectors(motions, durations, boxes) : boxes_plain(motions, durations, boxes);
}

}  // namespace orchard::runtime::detail
