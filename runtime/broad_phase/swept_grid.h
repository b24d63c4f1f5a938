#pragma once

#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"
#include "orchard/runtime/execution.h"

namespace orchard::runtime::detail {

inline constexpr unsigned kMinLineBits = 6, kMaxLineBits = 28;
// Returns the factors of a table of 2^bits lines; the first one is 1. The line of a cell is the sum of its coordinates
// times these factors, modulo 2^bits. Two cells that share a line are at least four cells apart along some axis.
std::array<std::uint32_t, 3> line_factors(unsigned bits) noexcept;

inline constexpr std::uint32_t kMaxCellsPerAxis = 4;  // the most cells along an axis that a box in the grid may take
static_assert(kMaxCellsPerAxis * kQuanta <= 256);     // the lengths of a PackedAabb are bytes

// Up to seven boxes, clipped to a cell and quantised to 5 bits for each coordinate, with the indices of their bodies,
// in one cache line. All seven are compared with another box at the same time: a guard bit above each field of 5 bits
// catches the carry of an addition.
inline constexpr std::uint64_t kGuards = 0x820820820u;  // bit 5 of each of six fields; an entry that meets nothing
inline constexpr std::uint32_t kLineRoom = 7;
struct alignas(64) CellLine {
  std::array<std::uint64_t, kLineRoom> entries;
  std::uint32_t count;     // the number of entries in use; the others are kGuards
  std::uint32_t overflow;  // 1 + the index of the line with further entries, or 0; a line that has one is full
};
static_assert(sizeof(CellLine) == 64);
inline constexpr CellLine kEmptyLine = {{kGuards, kGuards, kGuards, kGuards, kGuards, kGuards, kGuards}, 0, 0};
inline constexpr std::uint32_t kIdShift = 36;  // the first bit of the body's index in an entry, above the box

// What insertions into the grid have counted: bodies, entries, lines that were read, and pairs that were found.
struct GridCounts {
  std::uint64_t bodies = 0, entries = 0, lines_read = 0, pairs = 0;

  GridCounts& operator+=(const GridCounts& more) noexcept {
    bodies += more.bodies, entries += more.entries, lines_read += more.lines_read, pairs += more.pairs;
    return *this;
  }
};

// Return whether a box, or all boxes of a block, take few enough cells for the grid.
inline bool all_fit_grid(const BoxBlock& boxes) noexcept { return boxes.more_cells < kMaxCellsPerAxis; }
inline bool fits_grid(const QuantizedAabb& box) noexcept {
  bool fit = true;
  for (std::size_t d = 0; d < 3; ++d) {
    fit = fit && (box.upper[d] >> kQuantumBits) - (box.lower[d] >> kQuantumBits) < kMaxCellsPerAxis;
  }
  return fit;
}

// A hashed uniform grid of the boxes of bodies, with one cache line per cell. Cells that are far apart may share a
// line, which costs only time. The line of a cell is a sum of its coordinates times factors, so flat and thin worlds
// also use all lines evenly. Each pair of boxes is found once, in the cell that contains the lower corner of their
// intersection.
class SweptGrid {
 public:
  // The lines are divided into this many parts, each with overflow lines of its own. Several threads can insert boxes,
  // each into another part.
  static constexpr std::size_t kParts = 8;
  using Steps = std::uint8_t;  // how far a cell is from the first cell of a box: two bits for each axis, x the lowest
  using Cell = std::array<std::uint32_t, 3>;
  struct Visit {  // an entry of a body, and the cell that it goes to
    std::uint64_t entry;
    std::uint32_t line;
    Steps steps;
  };
  // A list of visits. append() makes room for a whole block, which is then written without checks.
  class Visits {
   public:
    void clear() noexcept { end_ = 0; }
    Visit* append(std::size_t more) {  // returns where the caller has to write `more` visits
      if (all_.size() < end_ + more) all_.resize(end_ + end_ / 8 + more);
      return all_.data() + std::exchange(end_, end_ + more);
    }
    std::span<const Visit> visits() const noexcept { return std::span(all_).first(end_); }
    std::size_t memory_bytes() const noexcept { return bytes_of(all_); }

   private:
    std::vector<Visit> all_;
    std::size_t end_ = 0;
  };
  using VisitsByPart = std::array<Visits, kParts>;

  // Removes all boxes, and makes room for about `lines` lines: a power of two near that number.
  void reset(std::size_t lines, const Executor& executor);
  void release();  // removes all boxes and gives the memory back

  // Boxes are added in two steps. The first one is encode(): it appends the visits of at most kBlock bodies with the
  // boxes of the block. Precondition: no box takes more than kMaxCellsPerAxis cells along an axis.
  void encode(std::span<const BodyIndex> bodies, const BoxBlock& block, Visits& visits) const;
  // Distributes visits among the parts of the grid, so that several threads can insert them.
  void split(const Visits& visits, VisitsByPart& parts) const;
  // The second step writes the entries, and appends the pairs of each new body with every body in the grid whose box it
  // meets. `boxes` is indexed by body and includes the new ones. Several threads may insert at the same time if the
  // visits of each are to another part.
  void insert(std::span<const Visit> visits, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
              GridCounts& counts);
  // Removes at most kRemovedAtOnce bodies. `boxes` is indexed by body.
  static constexpr std::size_t kRemovedAtOnce = 16;
  void remove(std::span<const BodyIndex> bodies, std::span<const PackedAabb> boxes) noexcept;

  // Calls use(body) for each entry in the cells of the box, and in other cells that share their lines. A body may occur
  // several times.
  template <typename Use>
  void visit_cells(const QuantizedAabb& box, const Use& use) const {
    for_each_cell(box, [&](const Cell&, std::uint32_t first) {
      const std::vector<CellLine>& more = overflow_[part_of(first)].lines;
      for (const CellLine* line = &lines_[first];; line = &more[line->overflow - 1]) {
        for (std::uint32_t i = 0; i < line->count; ++i) use(static_cast<BodyIndex>(line->entries[i] >> kIdShift));
        if (line->overflow == 0) return;
      }
    });
  }

  std::size_t memory_bytes() const noexcept;

 private:
  template <typename Use>
  ORCHARD_INLINE void for_each_cell(const QuantizedAabb& box, const Use& use) const {  // use(cell, line)
    const auto first = [&](std::size_t d) { return box.lower[d] >> kQuantumBits; };
    const auto last = [&](std::size_t d) { return box.upper[d] >> kQuantumBits; };
    Cell cell;
    for (cell[2] = first(2); cell[2] <= last(2); ++cell[2]) {
      for (cell[1] = first(1); cell[1] <= last(1); ++cell[1]) {
        const std::uint32_t row = cell[1] * factors_[1] + cell[2] * factors_[2];  // the first one is 1
        for (cell[0] = first(0); cell[0] <= last(0); ++cell[0]) use(cell, (cell[0] + row) & mask_);
      }
    }
  }
  struct Removal {
    BodyIndex body;
    std::uint32_t line;
  };
  Removal* list_removals(BodyIndex body, const QuantizedAabb& box, Removal* end) const noexcept;
  struct Overflow {
    std::vector<CellLine> lines;
    std::uint32_t free = 0;  // 1 + the index of the first free line, or 0
  };
  Visit* visit_rest(BodyIndex body, const QuantizedAabb& box, Visit* visit) const noexcept;
  struct Insertion;
  static void report(Insertion& insertion, const CellLine& line, std::uint64_t hits, const Visit& visit);
  void insert_beyond(Insertion& insertion, const Visit& visit);
  std::size_t part_of(std::uint32_t line) const noexcept { return line >> part_shift_; }
  static CellLine& add_line(CellLine& last, Overflow& more);
  static void remove_from(CellLine& line, BodyIndex body, Overflow& more) noexcept;

  std::vector<CellLine> lines_;
  std::array<Overflow, kParts> overflow_;
  std::uint32_t mask_ = 0;
  unsigned part_shift_ = 0;
  std::array<std::uint32_t, 3> factors_{};
  std::array<std::uint32_t, 8> corner_lines_{};  // from the line of a cell to those of its upper neighbours, by axes
};

}  // namespace orchard::runtime::detail
