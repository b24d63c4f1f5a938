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
struct alignas(64) CellLine {
  std::array<std::uint64_t, 7> entries;
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
  struct Visit {               // of a body to one of its cells
    std::uint64_t entry;
    std::uint32_t line;
    Steps steps;
  };
  // Room that is written without looking at it, once there is enough for a block.
  class Visits {
   public:
    void clear() noexcept { end_ = 0; }
    void make_room(std::size_t more) {
      if (all_.size() < end_ + more) all_.resize(end_ + end_ / 8 + more);
    }
    void add(const Visit& visit) noexcept { all_[end_++] = visit; }  // there is room
    Visit* end() noexcept { return all_.data() + end_; }             // the same, by where they are written,
    void end_at(const Visit* end) noexcept { end_ = static_cast<std::size_t>(end - all_.data()); }  // and how far
    std::span<const Visit> visits() const noexcept { return std::span(all_).first(end_); }
    std::size_t memory_bytes() const noexcept { return bytes_of(all_); }

   private:
    std::vector<Visit> all_;
    std::size_t end_ = 0;
  };
  using VisitsByPart = std::array<Visits, kParts>;

  // Makes room for at least `lines` lines, rounded up to a power of two. The lines are in memory as it is, until each
  // part has been emptied; nothing else happens to the part before that.
  void begin_reset(std::size_t lines);
  bool in_order() const noexcept { return in_order_; }  // whether all parts have been emptied
  void empty_part(std::size_t part) noexcept;           // unless they are in order
  void all_parts_emptied() noexcept { in_order_ = true; }
  void empty_parts(const Executor& executor);  // all of that
  void release();                              // its memory, too

  // Boxes are added in two steps: it is encoded which visits bodies[i] with block's box first + i make, at most kBatch
  // bodies, whose lines begin to be loaded; then these are made, and the pairs whose boxes meet are appended, of each
  // body in the grid with every other. `boxes` is by body and has the new ones, too. No box takes more than
  // kMaxCellsPerAxis cells along an axis.
  static constexpr std::size_t kBatch = 64;
  struct Batch;
  void encode(Batch& batch, std::span<const BodyIndex> bodies, const BoxBlock& block, std::size_t first) const noexcept;
  void insert(const Batch& batch, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs, GridCounts& counts);
  // The same for many bodies: the visits that block's bodies make, appended, at any number of threads; and visits to
  // one part, in the order in which they are to be made, at one thread for each part at most.
  void scatter(std::span<const BodyIndex> bodies, const BoxBlock& block, std::span<const PackedAabb> boxes,
               VisitsByPart& visits) const;
  void insert(std::span<const Visit> visits, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
              GridCounts& counts);
  class Removals;  // of a few bodies at a time
  void prepare_removal(BodyIndex body, const QuantizedAabb& box, Removals& removals) const noexcept;  // starts loading
  void remove(Removals& removals) noexcept;

  // Those that have entries in the cell, and in others that share its line; a body as often as it has.
  template <typename Visit>
  void visit_cell(const std::array<std::uint32_t, 3>& cell, const Visit& visit) const {
    const std::uint32_t first = line_of(cell);
    const std::vector<CellLine>& more = overflow_[part_of(first)].lines;
    for (const CellLine* line = &lines_[first];; line = &more[line->overflow - 1]) {
      for (std::uint32_t i = 0; i < line->count; ++i) visit(static_cast<BodyIndex>(line->entries[i] >> kIdShift));
      if (line->overflow == 0) return;
    }
  }

  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::size_t kMaxVisits = kMaxCellsPerAxis * kMaxCellsPerAxis * kMaxCellsPerAxis - 1;  // a body's
  struct Insertion;
  using Cell = std::array<std::uint32_t, 3>;
  using Numbers = std::array<std::uint32_t, kBatch>;
  std::uint32_t line_of(const Cell& cell) const noexcept {
    return (cell[0] * factors_[0] + cell[1] * factors_[1] + cell[2] * factors_[2]) & mask_;
  }
  struct Some {  // of a block's bodies: at most kBatch of them, the first of which has the box `first`
    std::span<const BodyIndex> bodies;
    const BoxBlock& block;
    std::size_t first;
  };
  void encode_all(Batch& batch, const Some& some) const noexcept;
  struct PutOff;
  template <typename Kind, typename Line, typename Entry, typename Query>
  void put_all(PutOff& put_off, std::size_t count, const Line& line_at, const Entry& entry_at,
               const Query& query_at) noexcept;
  template <typename Of>
  void finish_visits(Insertion& insertion, const PutOff& put_off, const Of& visit_at);
  void insert_visits(Insertion& insertion, std::span<const Visit> visits);
  struct Coded;
  struct AxisBits {  // of a block's bodies, a bit each: which take two cells along an axis, and which more along some
    std::uint64_t x, y, z, many;
  };
  void code(Coded& coded, const Some& some) const noexcept;
  static AxisBits bits_of(const Numbers& axes, std::size_t count) noexcept;
  void add_corners(Batch& batch, const Coded& coded, const AxisBits& bits) const noexcept;
  Visit* many_visits_of(BodyIndex body, const QuantizedAabb& box, Visit* visits) const noexcept;
  template <typename Kind>
  void insert_beyond(Insertion& insertion, const Visit& visit);
  void report(Insertion& insertion, const CellLine& line, std::uint64_t hits, BodyIndex body, Steps steps);
  struct Overflow {
    std::vector<CellLine> lines;
    std::uint32_t free = 0;  // 1 + index
  };
  std::size_t part_of(std::uint32_t line) const noexcept { return line >> part_shift_; }
  static void append(CellLine& line, std::uint64_t entry, Overflow& more);
  struct Removal {
    BodyIndex body;
    std::uint32_t line;
  };
  template <typename Kind>
  void remove_all(std::span<const Removal> removals) noexcept;
  template <typename Kind>
  static void remove_from(CellLine& line, BodyIndex body, Overflow& more) noexcept;
  static void free_last(CellLine& line, Overflow& more) noexcept;

  UnsetVector<CellLine> lines_;
  std::array<Overflow, kParts> overflow_;
  std::uint32_t mask_ = 0;
  unsigned part_shift_ = 0;
  std::array<std::uint32_t, 3> factors_{};
  bool in_order_ = true;
};

// The visits of a block's bodies: one of each to its first cell, then those to the other cells of bodies that take two
// along some axes. Bodies that take more are named.
struct SweptGrid::Batch {
  static constexpr std::size_t kMaxVisits = 8 * kBatch;
  template <typename T>
  using ByVisit = std::array<T, kMaxVisits>;
  ByVisit<std::uint64_t> entries, queries;
  ByVisit<std::uint32_t> lines;
  ByVisit<Steps> steps;
  std::array<BodyIndex, kBatch> large;         // bodies that take more than two cells along an axis
  std::size_t count = 0, end = 0, larges = 0;  // bodies, visits, and of the former those
};

class SweptGrid::Removals {
 public:
  static constexpr std::size_t kBodies = 16;

 private:
  friend class SweptGrid;
  std::array<Removal, kBodies*(kMaxVisits + 1) + 1> all_;  // what does not count is written, too
  std::size_t count_ = 0;
};

}  // namespace orchard::runtime::detail
