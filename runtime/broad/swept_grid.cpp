#include "swept_grid.h"

#include <bit>

#include "../vector_support.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint32_t kFieldBits = kQuantumBits + 1;
constexpr std::uint64_t kGuards = 0x820820820u;  // bit 5 of each of six fields
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

// A clipped box as an entry or as a query: entry's field <= query's field in all six means that they meet.
struct Code {
  std::uint64_t entry, query;
};

// An axis' two fields, of the box from `lower` to `upper` in the cell that begins at `first`.
ORCHARD_INLINE Code axis_code(std::uint32_t axis, std::uint32_t lower, std::uint32_t upper,
                              std::uint32_t first) noexcept {
  const std::uint32_t last = first + (kQuanta - 1);
  const std::uint64_t from = lower > first ? lower - first : 0;
  const std::uint64_t below = upper < last ? last - upper : 0;  // from the cell's end downwards
  return {from << (kFieldBits * axis) | below << (kFieldBits * (axis + 3)),
          (kQuanta - 1 - below) << (kFieldBits * axis) | (kQuanta - 1 - from) << (kFieldBits * (axis + 3))};
}

// Bit i: entry i of the line meets the query. Bits from line.count on mean nothing.
struct PlainCompare {
  static std::uint32_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < 7; ++i) {
      bits |= static_cast<std::uint32_t>(((query - line.entries[i]) & kGuards) == kGuards) << i;
    }
    return bits;
  }
};

#ifdef ORCHARD_VECTORS
struct VectorCompare {
  using Words __attribute__((vector_size(64))) = std::uint64_t;
  using Half __attribute__((vector_size(32))) = std::uint64_t;
  ORCHARD_INLINE static std::uint32_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const Words entries = load<Words>(line);                                              // the eighth is the counters
    const Words hit = reinterpret_cast<Words>(((query - entries) & kGuards) == kGuards);  // numbers are spread
    const Words bits = hit & Words{1, 2, 4, 8, 16, 32, 64, 0};
    const auto parts = std::bit_cast<std::array<Half, 2>>(bits);
    const Half sum = parts[0] | parts[1];
    return static_cast<std::uint32_t>((sum[0] | sum[1]) | (sum[2] | sum[3]));
  }
};
#endif

}  // namespace

struct SweptGrid::Insertion {
  Queue& queue;
  std::span<const BodyId> bodies;  // none: the last ones get in
  const BoxBlock* block;
  std::span<const QuantumBox> boxes;
  std::vector<BodyPair>& pairs;
};

// Of the entries hit, those whose box really meets the body's, and in this cell first.
void SweptGrid::report(const Insertion& insertion, const CellLine& line, std::uint32_t hits, BodyId body,
                       const Cell& cell) {
  const QuantumBox& box = insertion.boxes[body];
  for (; hits != 0; hits &= hits - 1) {
    const auto other = static_cast<BodyId>(line.entries[static_cast<std::size_t>(std::countr_zero(hits))] >> kIdShift);
    const QuantumBox& theirs = insertion.boxes[other];
    bool here = box.meets(theirs);
    for (std::size_t i = 0; i < 3; ++i) {
      here = here && std::max(box.lower[i], theirs.lower[i]) >> kQuantumBits == cell[i];
    }
    if (here) insertion.pairs.push_back(body < other ? BodyPair{body, other} : BodyPair{other, body});
  }
}

template <typename Kind, typename CellOf>
ORCHARD_INLINE void SweptGrid::insert_in_line(const Insertion& insertion, CellLine& first, std::uint64_t entry,
                                              std::uint64_t query, const CellOf& cell) {
  // Nothing is written before all seven entries have been read together: that would have to wait for the small writes.
  const std::uint32_t in_use = 0u - static_cast<std::uint32_t>(first.stamp == stamp_);  // a mask: no branch to guess
  const std::uint32_t count = first.count & in_use, more = first.overflow & in_use;
  const auto body = static_cast<BodyId>(entry >> kIdShift);
  ++counts_.entries;
  ++counts_.lines_read;
  const std::uint32_t hits = Kind::meeting(first, query) & ((1u << count) - 1);
  if (hits != 0) report(insertion, first, hits, body, cell());
  if (more == 0 && count < first.entries.size()) [[likely]] {
    first.entries[count] = entry;
    first.count = static_cast<std::uint16_t>(count + 1);
    first.stamp = stamp_;
    first.overflow = 0;
    return;
  }
  for (std::uint32_t next = more; next != 0;) {
    const CellLine& line = overflow_[next - 1];
    ++counts_.lines_read;
    const std::uint32_t met = Kind::meeting(line, query) & ((1u << line.count) - 1);
    if (met != 0) report(insertion, line, met, body, cell());
    next = line.overflow;
  }
  append(first, entry);
}

// Each body in the cell of its lower corner: a loop without branches that depend on the data.
ORCHARD_INLINE void SweptGrid::encode(Batch& batch, std::span<const BodyId> bodies,
                                      const BoxBlock& block) const noexcept {
  std::array<std::uint64_t, kBlock> entry, query;
  std::array<std::uint32_t, kBlock> line, several;
  const std::size_t lanes = lanes_for(bodies.size());
  for (std::size_t i = 0; i < lanes; ++i) entry[i] = 0, query[i] = kGuards, line[i] = 0, several[i] = 0;
  for (std::uint32_t d = 0; d < 3; ++d) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint32_t lower = block.lower[d][i], upper = block.upper[d][i], last = lower | (kQuanta - 1);
      const std::uint64_t from = lower & (kQuanta - 1), below = upper < last ? last - upper : 0;
      entry[i] |= from << (kFieldBits * d) | below << (kFieldBits * (d + 3));
      query[i] |= (kQuanta - 1 - below) << (kFieldBits * d) | (kQuanta - 1 - from) << (kFieldBits * (d + 3));
      line[i] |= ((lower >> kQuantumBits) & mask_[d]) << shift_[d];
      several[i] |= (lower ^ upper) >> kQuantumBits;
    }
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    prefetch(&lines_[line[i]]);  // they are all over memory
    batch.first[i] = {entry[i] | std::uint64_t{bodies[i]} << kIdShift, query[i], line[i], several[i] != 0};
  }
  batch.count = bodies.size();
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::flush(const Insertion& insertion) {
  Queue& queue = insertion.queue;
  for (std::size_t k = 0; k < queue.visits_waiting_; ++k) {
    const Visit& visit = queue.visits_[k];
    insert_in_line<Kind>(insertion, lines_[visit.line], visit.entry, visit.query,
                         [&]() ORCHARD_INLINE_LAMBDA { return visit.cell; });
  }
  queue.visits_waiting_ = 0;
}

// The batch that waited: first every body in its first cell, then the visits left from the batch before; the few
// bodies that take several cells leave visits to the others.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_waiting(const Insertion& insertion) {
  Queue& queue = insertion.queue;
  const Batch& batch = queue.batches_[queue.current_];
  std::array<std::uint32_t, kBlock> rest;
  std::size_t rests = 0;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    const First& first = batch.first[i];
    insert_in_line<Kind>(insertion, lines_[first.line], first.entry, first.query, [&]() ORCHARD_INLINE_LAMBDA {
      const QuantumBox& box = insertion.boxes[first.entry >> kIdShift];
      return Cell{box.lower[0] >> kQuantumBits, box.lower[1] >> kQuantumBits, box.lower[2] >> kQuantumBits};
    });
    rest[rests] = i;
    rests += first.several;
  }
  counts_.bodies += batch.count;
  flush<Kind>(insertion);

  for (std::size_t k = 0; k < rests; ++k) {
    const auto body = static_cast<BodyId>(batch.first[rest[k]].entry >> kIdShift);
    leave_visits<Kind>(insertion, body);
  }
}

// To all cells of the body's box but the first.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::leave_visits(const Insertion& insertion, BodyId body) {
  Queue& queue = insertion.queue;
  const QuantumBox& box = insertion.boxes[body];
  struct Slab {  // of cells, along an axis
    Code code;
    std::uint32_t line, cell;
  };
  std::array<std::array<Slab, kMostCellsPerAxis>, 3> slabs;
  std::array<std::uint32_t, 3> count;
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t first = box.lower[d] >> kQuantumBits;
    count[d] = (box.upper[d] >> kQuantumBits) - first + 1;
    for (std::uint32_t i = 0; i < count[d]; ++i) {
      const std::uint32_t cell = first + i;
      slabs[d][i] = {axis_code(d, box.lower[d], box.upper[d], cell << kQuantumBits), (cell & mask_[d]) << shift_[d],
                     cell};
    }
  }
  const std::uint64_t id = std::uint64_t{body} << kIdShift;
  for (std::uint32_t z = 0; z < count[2]; ++z) {
    for (std::uint32_t y = 0; y < count[1]; ++y) {
      for (std::uint32_t x = z == 0 && y == 0; x < count[0]; ++x) {
        const Slab &a = slabs[0][x], &b = slabs[1][y], &c = slabs[2][z];
        if (queue.visits_waiting_ == queue.visits_.size()) flush<Kind>(insertion);
        const std::uint32_t line = a.line | b.line | c.line;
        prefetch(&lines_[line]);
        queue.visits_[queue.visits_waiting_++] = {id | a.code.entry | b.code.entry | c.code.entry,
                                                  kGuards | a.code.query | b.code.query | c.code.query,
                                                  line,
                                                  {a.cell, b.cell, c.cell}};
      }
    }
  }
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::advance(const Insertion& insertion) {
  Queue& queue = insertion.queue;
  Batch& next = queue.batches_[1 - queue.current_];
  if (insertion.block != nullptr) encode(next, insertion.bodies, *insertion.block);
  insert_waiting<Kind>(insertion);
  if (insertion.block != nullptr) {
    queue.current_ = 1 - queue.current_;
  } else {
    flush<Kind>(insertion);
    queue.batches_[queue.current_].count = 0;
  }
}

void SweptGrid::advance_plain(const Insertion& insertion) { advance<PlainCompare>(insertion); }

#ifdef ORCHARD_VECTORS
ORCHARD_PER_MACHINE void SweptGrid::advance_vectors(const Insertion& insertion) { advance<VectorCompare>(insertion); }
#else
void SweptGrid::advance_vectors(const Insertion& insertion) { advance<PlainCompare>(insertion); }
#endif

void SweptGrid::run(const Insertion& insertion, bool vectors) {
  const std::size_t before = insertion.pairs.size();
  vectors ? advance_vectors(insertion) : advance_plain(insertion);
  counts_.pairs += insertion.pairs.size() - before;
}

void SweptGrid::insert(Queue& queue, std::span<const BodyId> bodies, const BoxBlock& block,
                       std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  run({queue, bodies, &block, boxes, pairs}, vectors);
}

void SweptGrid::finish(Queue& queue, std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  run({queue, {}, nullptr, boxes, pairs}, vectors);
}

}  // namespace orchard::runtime::detail
