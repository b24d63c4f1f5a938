#pragma once
#include <array>
#include <utility>

#include "roster.h"

namespace orchard::runtime::detail {

// A box in quanta, both ends included. A cell is kQuanta quanta wide.
struct QuantumBox {
  std::array<std::uint32_t, 3> lower, upper;

  bool meets(const QuantumBox& other) const noexcept {
    bool meet = true;
    for (std::size_t i = 0; i < 3; ++i) meet = meet && lower[i] <= other.upper[i] && other.lower[i] <= upper[i];
    return meet;
  }
};
inline constexpr std::uint32_t kQuantumBits = 5, kQuanta = 1u << kQuantumBits;
inline constexpr std::uint32_t kLastQuantum = 0x7fffffffu;
inline constexpr std::uint32_t kMostCellsPerAxis = 4;  // that a body's box may take; the grid has at least as many

inline constexpr std::size_t kBlock = 64;  // bodies that are worked on together
// Loops over a block go on to a multiple of eight: whole vectors.
inline std::size_t lanes_for(std::size_t count) noexcept { return (count + 7) & ~std::size_t{7}; }

// What is asked about a block of bodies, by coordinate, so that the loops over bodies become vector instructions.
struct MotionBlock {
  std::array<std::array<double, kBlock>, 3> position{}, velocity{};
  std::array<double, kBlock> radius{}, acceleration{}, drift{}, duration{};

  void set(std::size_t i, const Motion& motion, double seconds) noexcept {
    for (std::size_t d = 0; d < 3; ++d) {
      position[d][i] = motion.position[d];
      velocity[d][i] = motion.velocity[d];
    }
    radius[i] = motion.radius;
    acceleration[i] = motion.acceleration;
    drift[i] = motion.drift;
    duration[i] = seconds;
  }
};

struct BoxBlock {
  std::array<std::array<std::uint32_t, kBlock>, 3> lower{}, upper{};

  QuantumBox get(std::size_t i) const noexcept {
    return {{lower[0][i], lower[1][i], lower[2][i]}, {upper[0][i], upper[1][i], upper[2][i]}};
  }
  void set(std::size_t i, const QuantumBox& box) noexcept {
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d][i] = box.lower[d];
      upper[d][i] = box.upper[d];
    }
  }
};

// Where quanta lie in space. Monotone, and outward: boxes that meet in space meet in quanta.
class Lattice {
 public:
  Lattice() = default;
  Lattice(const Vec3& origin, double cell_size) noexcept;

  const Vec3& origin() const noexcept { return origin_; }
  // Each box holds its body's sphere for `duration` seconds from the motion's time. Of the first `count` bodies.
  void boxes(const MotionBlock& motions, std::size_t count, BoxBlock& boxes, bool vectors) const noexcept;

 private:
  void boxes_plain(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept;
  void boxes_vectors(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept;
  void make_boxes(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept;

  Vec3 origin_{};
  double per_length_ = 1;  // quanta
  double margin_ = 0;      // quanta: rounding here, and kMotionSlack
};

// Seven boxes clipped to a cell, quantised to 5 bits a coordinate, with their bodies' ids: one cache line. All seven
// are compared with another box in one go: per coordinate a guard bit above the 5 catches the borrow of a subtraction.
struct alignas(64) CellLine {
  std::array<std::uint64_t, 7> entries;
  std::uint32_t count;
  std::uint32_t overflow;  // 1 + the index of the line with more entries; 0: none
};
static_assert(sizeof(CellLine) == 64);

struct GridCounts {
  std::uint64_t bodies = 0, entries = 0, lines_read = 0, pairs = 0;
};

// The boxes of all bodies in a hashed uniform grid: cells far apart may share a line, which costs time only.
// (The idea of one cache line per cell and the lower-corner rule: each pair of boxes is found in the one cell that
// holds the lower corner of what they have in common.)
class SweptGrid {
 public:
  // Empties the grid. At least `lines` lines, rounded up to a power of two.
  void reset(std::size_t lines);

  // Adds bodies[i] with block's box i, at most kBlock of them, and appends the pairs whose boxes meet, of each of them
  // and everything added before. `boxes` is by body and has the new ones, too. No box takes more than kMostCellsPerAxis
  // cells along an axis.
  void insert(std::span<const BodyId> bodies, const BoxBlock& block, std::span<const QuantumBox> boxes, bool vectors,
              std::vector<BodyPair>& pairs);
  void remove(BodyId body, const QuantumBox& box) noexcept;
  void prepare_removal(const QuantumBox& box) const noexcept;  // starts loading

  std::size_t lines() const noexcept { return lines_.size(); }
  const GridCounts& counts() const noexcept { return counts_; }  // of insertions, since they were taken
  GridCounts take_counts() noexcept { return std::exchange(counts_, {}); }
  std::size_t memory_bytes() const noexcept { return bytes_of(lines_) + bytes_of(overflow_); }

 private:
  struct Insertion;
  struct Visit;
  using Cell = std::array<std::uint32_t, 3>;
  std::size_t line_of(const Cell& cell) const noexcept;
  template <typename Kind>
  void insert_all(const Insertion& insertion);
  void insert_plain(const Insertion& insertion);
  void insert_vectors(const Insertion& insertion);
  template <typename Kind>
  void insert_in_line(const Insertion& insertion, CellLine& line, std::uint64_t entry, std::uint64_t query,
                      const Cell& cell);
  void report(const Insertion& insertion, const CellLine& line, std::uint32_t hits, BodyId body, const Cell& cell);
  void append(CellLine& line, std::uint64_t entry);
  void remove_from(CellLine& line, BodyId body) noexcept;
  void free_last(CellLine& line) noexcept;

  std::vector<CellLine> lines_, overflow_;
  std::uint32_t free_overflow_ = 0;  // 1 + index
  std::array<std::uint32_t, 3> mask_{}, shift_{};
  GridCounts counts_;
};

}  // namespace orchard::runtime::detail
