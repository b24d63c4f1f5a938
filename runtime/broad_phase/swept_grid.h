#pragma once

#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"
#include "orchard/runtime/execution.h"

namespace orchard::runtime::detail {

// Tables of 2^bits lines: the line of a cell is the sum of its coordinates times these, modulo their number. Cells that
// share one are never within three of each other along every axis.
inline constexpr unsigned kMinLineBits = 6, kMaxLineBits = 28;
std::array<std::uint32_t, 3> line_factors(unsigned bits) noexcept;  // the first one is 1

inline constexpr std::uint32_t kMaxCellsPerAxis = 4;  // that a body's box may take; the grid has at least as many
static_assert(kMaxCellsPerAxis * kQuanta <= 256);     // the lengths of a narrow box are bytes

// Seven boxes clipped to a cell, quantised to 5 bits a coordinate, with their bodies' ids: one cache line. All seven
// are compared with another box in one go: per coordinate a guard bit above the 5 catches the carry of an addition.
inline constexpr std::uint64_t kGuards = 0x820820820u;  // bit 5 of each of six fields; an entry that meets nothing
inline constexpr std::uint32_t kLineRoom = 7;
struct alignas(64) CellLine {
  std::array<std::uint64_t, kLineRoom> entries;
  std::uint32_t count;     // entries; the others are kGuards
  std::uint32_t overflow;  // 1 + the index of the line with more entries; 0: none. A line that has one is full
};
static_assert(sizeof(CellLine) == 64);
inline constexpr CellLine kEmptyLine = {{kGuards, kGuards, kGuards, kGuards, kGuards, kGuards, kGuards}, 0, 0};
inline constexpr std::uint32_t kIdShift = 36;  // of the body in an entry, above its box

struct GridCounts {
  std::uint64_t bodies = 0, entries = 0, lines_read = 0, pairs = 0;

  GridCounts& operator+=(const GridCounts& more) noexcept {
    bodies += more.bodies, entries += more.entries, lines_read += more.lines_read, pairs += more.pairs;
    return *this;
  }
};

// Whether a box, or all of these, take few enough cells for the grid.
inline bool all_fit_grid(const BoxBlock& boxes) noexcept { return boxes.more_cells < kMaxCellsPerAxis; }
inline bool fits_grid(const QuantizedAabb& box) noexcept {
  bool fit = true;
  for (std::size_t d = 0; d < 3; ++d) {
    fit = fit && (box.upper[d] >> kQuantumBits) - (box.lower[d] >> kQuantumBits) < kMaxCellsPerAxis;
  }
  return fit;
}

// The boxes of all bodies in a hashed uniform grid: cells far apart may share a line, which costs time only. A cell's
// line is a sum of its coordinates times a factor each, so that flat and thin worlds, too, use all lines evenly.
// (The idea of one cache line per cell and the lower-corner rule: each pair of boxes is found in the one cell that
// holds the lower corner of what they have in common.)
class SweptGrid {
 public:
  // The lines are in this many parts, each with what overflows of its own: boxes can be put in by several threads.
  static constexpr std::size_t kParts = 8;
  using Steps = std::uint8_t;  // from a body's first cell, along each axis: two bits each, from the lowest ones on
  using Cell = std::array<std::uint32_t, 3>;
  struct Visit {  // of a body to one of its cells
    std::uint64_t entry;
    std::uint32_t line;
    Steps steps;
  };
  // Room that is written without looking at it, once there is enough for a block.
  class Visits {
   public:
    void clear() noexcept { end_ = 0; }
    Visit* append(std::size_t more) {  // so many, which are written where it says
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

  // Empties it, and makes room for at least `lines` lines, rounded up to a power of two.
  void reset(std::size_t lines, const Executor& executor);
  void release();  // its memory, too

  // Boxes are added in two steps. First it is encoded which visits at most kBlock bodies with the block's boxes make.
  // No box takes more than kMaxCellsPerAxis cells along an axis.
  void encode(std::span<const BodyIndex> bodies, const BoxBlock& block, Visits& visits) const;
  void split(const Visits& visits, VisitsByPart& parts) const;  // appends them to those of their parts
  // Then these are made, and the pairs whose boxes meet are appended, of each body in the grid with every other.
  // `boxes` is by body and has the new ones, too. With the visits to one part, by one thread for each at most.
  void insert(std::span<const Visit> visits, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
              GridCounts& counts);
  void prepare_removal(const PackedAabb& box) const noexcept;  // starts loading its lines
  void remove(BodyIndex body, const QuantizedAabb& box) noexcept;

  // Visits those that have entries in the box's cells, and in others that share their lines; a body as often as it has.
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
  template <typename Use>
  void for_each_line(const QuantizedAabb& box, const Use& use) const noexcept;
  struct Overflow {
    std::vector<CellLine> lines;
    std::uint32_t free = 0;  // 1 + index
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
  std::array<std::uint32_t, 8> corner_lines_{};  // how much further the lines of a cell's neighbours are
};

}  // namespace orchard::runtime::detail
