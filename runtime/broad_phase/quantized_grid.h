#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "broad_phase/clock.h"

namespace orchard::runtime::detail {

// A box in quanta, both ends included. A cell is kQuanta quanta wide.
struct QuantizedAabb {
  std::array<std::uint32_t, 3> lower, upper;

  bool meets(const QuantizedAabb& other) const noexcept {
    bool meet = true;
    for (std::size_t i = 0; i < 3; ++i) meet = meet && lower[i] <= other.upper[i] && other.lower[i] <= upper[i];
    return meet;
  }
  void include(const QuantizedAabb& other) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], other.lower[i]);
      upper[i] = std::max(upper[i], other.upper[i]);
    }
  }
};
// One that takes four cells along an axis at most, in two thirds of the memory: how far each upper end lies above the
// lower one, a byte each. Of another box nothing but its lower ends is right.
struct alignas(16) PackedAabb {
  std::array<std::uint32_t, 3> lower;
  std::uint32_t lengths;

  PackedAabb() = default;
  explicit PackedAabb(const QuantizedAabb& box) noexcept : lower(box.lower), lengths(0) {
    for (std::size_t d = 0; d < 3; ++d) lengths |= (box.upper[d] - box.lower[d]) << 8 * d;
  }
  QuantizedAabb whole() const noexcept {
    return {lower, {lower[0] + (lengths & 0xff), lower[1] + (lengths >> 8 & 0xff), lower[2] + (lengths >> 16 & 0xff)}};
  }
  bool meets(const QuantizedAabb& other) const noexcept { return whole().meets(other); }
};
inline constexpr std::uint32_t kQuantumBits = 6, kQuanta = 1u << kQuantumBits;
inline constexpr std::uint32_t kLastQuantum = 0x7fffffffu;
inline constexpr QuantizedAabb kNoBox = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};  // around nothing

inline constexpr std::size_t kBlock = 64;  // bodies that are worked on together, at most
// Loops over a block go on to a multiple of eight: whole vectors.
inline std::size_t lanes_for(std::size_t count) noexcept { return (count + 7) & ~std::size_t{7}; }

// By coordinate, so that the loops over bodies become vector instructions.
struct BoxBlock {
  std::array<std::array<std::uint32_t, kBlock>, 3> lower, upper;
  std::array<std::uint32_t, kBlock> lengths;  // as in PackedAabb
  // Of all boxes that were made together:
  QuantizedAabb around;      // what includes them
  std::uint32_t more_cells;  // bits of how many cells they take along an axis beyond one

  QuantizedAabb get(std::size_t i) const noexcept {
    return {{lower[0][i], lower[1][i], lower[2][i]}, {upper[0][i], upper[1][i], upper[2][i]}};
  }
  // Box i to places[i].
  void store(std::span<const std::uint32_t> places, std::span<PackedAabb> to) const noexcept;
  void set(std::size_t i, const QuantizedAabb& box) noexcept {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d][i] = box.lower[d];
      upper[d][i] = box.upper[d];
    }
    lengths[i] = PackedAabb(box).lengths;
  }
};

// Where quanta lie in space. Monotone, and outward: boxes that meet in space meet in quanta. It may move with a crowd
// that flies all the same way: what meets in space meets there at the same time.
class QuantizedGrid {
 public:
  QuantizedGrid() = default;
  // Made at the step `now`. slack: what positions may be wrong by.
  QuantizedGrid(const Vec3& origin, const Vec3& velocity, double cell_size, double slack, const Clock& clock,
                Step now) noexcept;

  QuantizedGrid at(Step now) const noexcept;               // where it has moved to
  const Vec3& origin() const noexcept { return origin_; }  // where it has moved to
  const Vec3& velocity() const noexcept { return velocity_; }
  bool moves() const noexcept { return velocity_ != kNoVelocity; }
  // Where a point lies along an axis, to less than a quantum if it lies within the quantized grid.
  double quantum(double coordinate, std::size_t axis) const noexcept;
  double quanta(double length) const noexcept { return length * per_length_; }
  // Box i holds body i's sphere for durations[i] seconds from its motion's time; at most kBlock of them. False if a
  // motion may not be valid, which costs next to nothing to tell here; its expiry is not looked at.
  bool boxes(std::span<const Motion> motions, std::span<const double> durations, BoxBlock& boxes) const noexcept;

 private:
  template <typename Kind, typename Row>
  typename Kind::Mask make_some(const Row& row, const double* durations, BoxBlock& boxes,
                                std::size_t first) const noexcept;
  template <typename Kind>
  bool make_all(std::span<const Motion> motions, std::span<const double> durations, BoxBlock& boxes) const noexcept;

  void move_to(Step now) noexcept;

  Vec3 first_{}, origin_{};  // where it was made, and where it is
  Vec3 velocity_{};
  double per_length_ = 1;  // quanta
  double time_step_ = 0;
  Step made_at_ = 0;
  double slack_ = 0;
  double margin_ = 0;  // quanta: rounding here, and kMotionSlack
};

}  // namespace orchard::runtime::detail
