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
// A box that takes at most four cells along each axis, in two thirds of the memory of a QuantizedAabb. `lengths` has a
// byte for each axis: how far the upper end is above the lower end. For a larger box, only the lower ends are right.
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
inline constexpr QuantizedAabb kNoBox = {{kLastQuantum, kLastQuantum, kLastQuantum}, {0, 0, 0}};  // empty

inline constexpr std::size_t kBlock = 256;  // the maximum number of bodies that are processed together
// Returns `count` rounded up to a multiple of eight: loops over a block process whole vectors.
inline std::size_t lanes_for(std::size_t count) noexcept { return (count + 7) & ~std::size_t{7}; }

// A block of boxes, stored by coordinate so that the loops over bodies become vector instructions.
struct BoxBlock {
  std::array<std::array<std::uint32_t, kBlock>, 3> lower, upper;
  QuantizedAabb around;      // contains all boxes of the block
  std::uint32_t more_cells;  // the bitwise or, over all boxes and axes, of the number of cells beyond the first one

  QuantizedAabb get(std::size_t i) const noexcept {
    return {{lower[0][i], lower[1][i], lower[2][i]}, {upper[0][i], upper[1][i], upper[2][i]}};
  }
  // Writes box i to to[places[i]].
  void store(std::span<const std::uint32_t> places, std::span<PackedAabb> to) const noexcept;
  void set(std::size_t i, const QuantizedAabb& box) noexcept {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d][i] = box.lower[d];
      upper[d][i] = box.upper[d];
    }
  }
};

// Maps space to quanta. The map is monotone, and boxes are rounded outward, so boxes that meet in space meet in quanta.
// The grid may move with a crowd of bodies that all fly the same way. It then maps motions relative to its own, so
// bodies that meet in space at some time still meet in quanta.
class QuantizedGrid {
 public:
  QuantizedGrid() = default;
  // Makes a grid at the step `now`. `slack` is a bound on the error of positions.
  QuantizedGrid(const Vec3& origin, const Vec3& velocity, double cell_size, double slack, const Clock& clock,
                Step now) noexcept;

  QuantizedGrid at(Step now) const noexcept;               // returns the grid where it is at a step
  const Vec3& origin() const noexcept { return origin_; }  // where it is now
  const Vec3& velocity() const noexcept { return velocity_; }
  bool moves() const noexcept { return velocity_ != kNoVelocity; }
  // Returns the quantum of a coordinate. For points within the range of the grid, the error is less than one quantum.
  double quantum(double coordinate, std::size_t axis) const noexcept;
  double quanta(double length) const noexcept { return length * per_length_; }
  // Makes at most kBlock boxes. Box i contains the sphere of a body with motions[i] for durations[i] seconds from the
  // time of the motion. Returns false if a motion may be invalid; its expiry is not looked at. The check costs next to
  // nothing here.
  bool boxes(std::span<const Motion> motions, std::span<const double> durations, BoxBlock& boxes) const noexcept;

 private:
  template <typename Kind, typename Row>
  typename Kind::Mask make_some(const Row& row, const double* durations, BoxBlock& boxes,
                                std::size_t first) const noexcept;
  template <typename Kind>
  bool make_all(std::span<const Motion> motions, std::span<const double> durations, BoxBlock& boxes) const noexcept;

  void move_to(Step now) noexcept;

  Vec3 first_{}, origin_{};  // the origin when it was made, and now
  Vec3 velocity_{};
  double per_length_ = 1;  // the number of quanta in a unit of length
  double time_step_ = 0;
  Step made_at_ = 0;
  double slack_ = 0;
  double margin_ = 0;  // in quanta: a bound on rounding here, on kMotionSlack and on `slack`
};

}  // namespace orchard::runtime::detail
