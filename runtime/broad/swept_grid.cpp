#include "swept_grid.h"

#include <bit>

#include "../machine.h"
#include "../vector_support.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint32_t kFieldBits = kQuantumBits + 1;
constexpr std::uint64_t kGuards = 0x820820820u;  // bit 5 of each of six fields
constexpr std::uint32_t kLargest = 0x1f7dfu;     // three fields, each of them kQuanta - 1
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

std::uint64_t first_bytes(std::uint32_t count) noexcept { return (std::uint64_t{1} << (8 * count)) - 1; }

// A box clipped to a cell, in three fields each: how far it begins from the cell's lower end, and ends from its upper
// end. As an entry or as a query: entry's field <= query's field in all six means that they meet.
ORCHARD_INLINE std::uint64_t entry_of(std::uint32_t from, std::uint32_t below) noexcept {
  return std::uint64_t{below} << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_of(std::uint32_t from, std::uint32_t below) noexcept {
  return entry_of(kLargest - below, kLargest - from) | kGuards;
}

// Bit 8 i: entry i of the line meets the query. Only the first line.count bytes mean anything.
struct PlainCompare {
  static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    std::uint64_t bits = 0;
    for (std::uint32_t i = 0; i < 7; ++i) {
      bits |= std::uint64_t{((query - line.entries[i]) & kGuards) == kGuards} << (8 * i);
    }
    return bits;
  }
};

#ifdef ORCHARD_VECTORS
struct VectorCompare {
  using Words __attribute__((vector_size(64))) = std::uint64_t;
  using Bytes __attribute__((vector_size(8))) = std::uint8_t;
  ORCHARD_INLINE static std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
    const Words entries = load<Words>(line);                    // the eighth is the counters
    const auto hit = ((query - entries) & kGuards) == kGuards;  // numbers are spread
    return std::bit_cast<std::uint64_t>(__builtin_convertvector(-hit, Bytes));
  }
};
#endif

}  // namespace

struct SweptGrid::Insertion {
  Queue& queue;
  std::span<const BodyIndex> bodies;  // none: the last ones get in
  const BoxBlock* block;
  std::span<const QuantumBox> boxes;
  std::vector<BodyPair>& pairs;
};

// Of the entries hit, those whose box really meets the body's, and in this cell first.
void SweptGrid::report(const Insertion& insertion, const CellLine& line, std::uint64_t hits, BodyIndex body,
                       Steps steps) {
  const QuantumBox& box = insertion.boxes[body];
  for (; hits != 0; hits &= hits - 1) {
    const std::uint64_t entry = line.entries[static_cast<std::size_t>(std::countr_zero(hits)) / 8];
    const auto other = static_cast<BodyIndex>(entry >> kIdShift);
    const QuantumBox& theirs = insertion.boxes[other];
    bool here = box.meets(theirs);
    for (std::size_t d = 0; d < 3; ++d) {
      const std::uint32_t cell = (box.lower[d] >> kQuantumBits) + steps[d];
      here = here && std::max(box.lower[d], theirs.lower[d]) >> kQuantumBits == cell;
    }
    if (here) insertion.pairs.push_back(body < other ? BodyPair{body, other} : BodyPair{other, body});
  }
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_in_line(const Insertion& insertion, const Visit& visit) {
  // Nothing is written before all seven entries have been read together: that would have to wait for the small writes.
  CellLine& first = lines_[visit.line];
  const auto body = static_cast<BodyIndex>(visit.entry >> kIdShift);
  const std::uint32_t count = first.count, more = first.overflow;
  const std::uint64_t hits = Kind::meeting(first, visit.query) & first_bytes(count);
  if (hits != 0) report(insertion, first, hits, body, visit.steps);
  if (more == 0 && count < first.entries.size()) [[likely]] {
    first.entries[count] = visit.entry;
    first.count = count + 1;
    return;
  }
  for (std::uint32_t next = more; next != 0;) {
    const CellLine& line = overflow_[next - 1];
    ++counts_.lines_read;
    const std::uint64_t met = Kind::meeting(line, visit.query) & first_bytes(line.count);
    if (met != 0) report(insertion, line, met, body, visit.steps);
    next = line.overflow;
  }
  append(first, visit.entry);
}

// Loops without branches that depend on the data.
ORCHARD_INLINE void SweptGrid::encode(Batch& batch, std::span<const BodyIndex> bodies,
                                      const BoxBlock& block) const noexcept {
  using Numbers = std::array<std::uint32_t, kBlock>;
  const std::size_t lanes = lanes_for(bodies.size());
  Numbers all_from{}, all_below{}, all_line{}, axes{};
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t field = kFieldBits * d, mask = mask_[d], shift = shift_[d];
    Numbers from, below, line, next_below, next_line;
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint32_t lower = block.lower[d][i], upper = block.upper[d][i];
      const std::uint32_t cell = lower >> kQuantumBits, last = upper >> kQuantumBits;
      from[i] = (lower & (kQuanta - 1)) << field;
      next_below[i] = (~upper & (kQuanta - 1)) << field;
      below[i] = last > cell ? 0 : next_below[i];
      line[i] = (cell & mask) << shift;
      next_line[i] = (last & mask) << shift;
      axes[i] |= (last > cell ? 1u : 0u) << d | (last > cell + 1 ? 8u : 0u);
      all_from[i] |= from[i];
      all_below[i] |= below[i];
      all_line[i] |= line[i];
    }
    batch.from[d] = from;
    batch.below[0][d] = below, batch.below[1][d] = next_below;
    batch.lines[0][d] = line, batch.lines[1][d] = next_line;
  }
  batch.axes = axes;
  batch.line = all_line;
  batch.count = bodies.size();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    batch.bodies[i] = bodies[i];
    batch.entry[i] = entry_of(all_from[i], all_below[i]) | std::uint64_t{bodies[i]} << kIdShift;
    batch.query[i] = query_of(all_from[i], all_below[i]);
    prefetch(&lines_[all_line[i]]);  // they are all over memory
  }
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::flush(const Insertion& insertion) {
  Queue& queue = insertion.queue;
  for (std::size_t k = 0; k < queue.visits_waiting_; ++k) insert_in_line<Kind>(insertion, queue.visits_[k]);
  counts_.entries += queue.visits_waiting_;
  counts_.lines_read += queue.visits_waiting_;
  queue.visits_waiting_ = 0;
}

// The batch that waited: first every body in its first cell, then the visits left from the batch before; bodies that
// take several cells leave visits to the others.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_waiting(const Insertion& insertion) {
  const Batch& batch = insertion.queue.batches_[insertion.queue.current_];
  std::array<std::uint32_t, kBlock> rest;
  std::size_t rests = 0;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    insert_in_line<Kind>(insertion, {batch.entry[i], batch.query[i], batch.line[i], {0, 0, 0}});
    rest[rests] = i;
    rests += batch.axes[i] != 0;
  }
  counts_.bodies += batch.count;
  counts_.entries += batch.count;
  counts_.lines_read += batch.count;
  flush<Kind>(insertion);
  for (std::size_t k = 0; k < rests; ++k) leave_visits<Kind>(insertion, batch, rest[k]);
}

// To all cells of a body's box but the first.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::leave_visits(const Insertion& insertion, const Batch& batch, std::uint32_t i) {
  Queue& queue = insertion.queue;
  if (queue.visits_waiting_ + kMostVisits > queue.visits_.size()) flush<Kind>(insertion);
  const std::uint32_t axes = batch.axes[i];
  if (axes >= 8) {
    leave_many_visits(queue, batch.bodies[i], insertion.boxes[batch.bodies[i]]);
    return;
  }
  const std::uint64_t id = std::uint64_t{batch.bodies[i]} << kIdShift;
  for (std::uint32_t corner = axes; corner != 0; corner = (corner - 1) & axes) {
    const Steps steps = {static_cast<std::uint8_t>(corner & 1), static_cast<std::uint8_t>(corner >> 1 & 1),
                         static_cast<std::uint8_t>(corner >> 2)};
    std::uint32_t from = 0, below = 0, line = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      if (steps[d] == 0) from |= batch.from[d][i];
      below |= batch.below[steps[d]][d][i];
      line |= batch.lines[steps[d]][d][i];
    }
    prefetch(&lines_[line]);
    queue.visits_[queue.visits_waiting_++] = {entry_of(from, below) | id, query_of(from, below), line, steps};
  }
}

void SweptGrid::leave_many_visits(Queue& queue, BodyIndex body, const QuantumBox& box) const noexcept {
  Cell first, count;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = box.lower[d] >> kQuantumBits;
    count[d] = (box.upper[d] >> kQuantumBits) - first[d] + 1;
  }
  Steps steps;
  for (steps[2] = 0; steps[2] < count[2]; ++steps[2]) {
    for (steps[1] = 0; steps[1] < count[1]; ++steps[1]) {
      for (steps[0] = steps[1] == 0 && steps[2] == 0; steps[0] < count[0]; ++steps[0]) {
        const Cell cell = {first[0] + steps[0], first[1] + steps[1], first[2] + steps[2]};
        std::uint32_t from = 0, below = 0;
        for (std::uint32_t i = 0; i < 3; ++i) {
          const std::uint32_t begin = cell[i] << kQuantumBits, end = begin + (kQuanta - 1);
          from |= (box.lower[i] > begin ? box.lower[i] - begin : 0) << kFieldBits * i;
          below |= (box.upper[i] < end ? end - box.upper[i] : 0) << kFieldBits * i;
        }
        queue.visits_[queue.visits_waiting_++] = {entry_of(from, below) | std::uint64_t{body} << kIdShift,
                                                  query_of(from, below), line_of(cell), steps};
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
void SweptGrid::advance_vectors(const Insertion& insertion) {
  detail::per_machine([&]() ORCHARD_INLINE_LAMBDA { advance<VectorCompare>(insertion); });
}
#else
void SweptGrid::advance_vectors(const Insertion& insertion) { advance<PlainCompare>(insertion); }
#endif

void SweptGrid::run(const Insertion& insertion, bool vectors) {
  const std::size_t before = insertion.pairs.size();
  vectors ? advance_vectors(insertion) : advance_plain(insertion);
  counts_.pairs += insertion.pairs.size() - before;
}

void SweptGrid::insert(Queue& queue, std::span<const BodyIndex> bodies, const BoxBlock& block,
                       std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  run({queue, bodies, &block, boxes, pairs}, vectors);
}

void SweptGrid::finish(Queue& queue, std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  run({queue, {}, nullptr, boxes, pairs}, vectors);
}

}  // namespace orchard::runtime::detail
