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

Code code_of(const QuantumBox& box, const std::array<std::uint32_t, 3>& cell) noexcept {
  Code code{0, kGuards};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t first = cell[i] << kQuantumBits, last = first + (kQuanta - 1);
    const std::uint64_t lower = box.lower[i] > first ? box.lower[i] - first : 0;
    const std::uint64_t below = box.upper[i] < last ? last - box.upper[i] : 0;  // from the cell's end downwards
    code.entry |= lower << (kFieldBits * i) | below << (kFieldBits * (i + 3));
    code.query |= (kQuanta - 1 - below) << (kFieldBits * i) | (kQuanta - 1 - lower) << (kFieldBits * (i + 3));
  }
  return code;
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
void SweptGrid::report(const Insertion& insertion, const CellLine& line, std::uint32_t hits, const Visit& visit) {
  const BodyId body = visit.body();
  const QuantumBox& box = insertion.boxes[body];
  for (; hits != 0; hits &= hits - 1) {
    const auto other = static_cast<BodyId>(line.entries[static_cast<std::size_t>(std::countr_zero(hits))] >> kIdShift);
    const QuantumBox& theirs = insertion.boxes[other];
    bool here = box.meets(theirs);
    for (std::size_t d = 0; d < 3; ++d) {
      const std::uint32_t cell = (box.lower[d] >> kQuantumBits) + visit.steps[d];
      here = here && std::max(box.lower[d], theirs.lower[d]) >> kQuantumBits == cell;
    }
    if (here) insertion.pairs.push_back(body < other ? BodyPair{body, other} : BodyPair{other, body});
  }
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_in_line(const Insertion& insertion, const Visit& visit) {
  // Nothing is written before all seven entries have been read together: that would have to wait for the small writes.
  CellLine& first = lines_[visit.line];
  const std::uint32_t count = first.count, more = first.overflow;
  ++counts_.entries;
  ++counts_.lines_read;
  const std::uint32_t hits = Kind::meeting(first, visit.query) & ((1u << count) - 1);
  if (hits != 0) report(insertion, first, hits, visit);
  if (more == 0 && count < first.entries.size()) [[likely]] {
    first.entries[count] = visit.entry;
    first.count = count + 1;
    return;
  }
  for (std::uint32_t next = more; next != 0;) {
    const CellLine& line = overflow_[next - 1];
    ++counts_.lines_read;
    const std::uint32_t met = Kind::meeting(line, visit.query) & ((1u << line.count) - 1);
    if (met != 0) report(insertion, line, met, visit);
    next = line.overflow;
  }
  append(first, visit.entry);
}

// A loop without branches that depend on the data.
ORCHARD_INLINE void SweptGrid::encode(Batch& batch, std::span<const BodyId> bodies,
                                      const BoxBlock& block) const noexcept {
  const std::size_t lanes = lanes_for(bodies.size());
  std::array<std::uint32_t, kBlock> axes;
  for (std::size_t i = 0; i < lanes; ++i) axes[i] = 0;
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t low = kFieldBits * d, high = kFieldBits * (d + 3), mask = mask_[d], shift = shift_[d];
    std::array<std::uint64_t, kBlock> entry, query, next_entry, next_query;
    std::array<std::uint32_t, kBlock> line, next_line;
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint32_t lower = block.lower[d][i], upper = block.upper[d][i];
      const std::uint32_t cell = lower >> kQuantumBits, last = upper >> kQuantumBits;
      const std::uint64_t from = lower & (kQuanta - 1), to = upper & (kQuanta - 1);
      const std::uint64_t below = last > cell ? 0 : kQuanta - 1 - to;  // from the cell's end downwards
      entry[i] = from << low | below << high;
      query[i] = (kQuanta - 1 - below) << low | (kQuanta - 1 - from) << high;
      line[i] = (cell & mask) << shift;
      next_entry[i] = (kQuanta - 1 - to) << high;
      next_query[i] = to << low | std::uint64_t{kQuanta - 1} << high;
      next_line[i] = (last & mask) << shift;
      axes[i] |= (last > cell ? 1u : 0u) << d | (last > cell + 1 ? 8u : 0u);
    }
    const auto keep = [&](const auto& from, auto& to) { std::copy_n(from.begin(), lanes, to.begin()); };
    keep(entry, batch.entry[0][d]), keep(query, batch.query[0][d]), keep(line, batch.line[0][d]);
    keep(next_entry, batch.entry[1][d]), keep(next_query, batch.query[1][d]), keep(next_line, batch.line[1][d]);
  }
  std::copy_n(axes.begin(), lanes, batch.axes.begin());
  batch.count = bodies.size();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    batch.bodies[i] = bodies[i];
    prefetch(&lines_[Batch::sum(batch.line, 0, 0, 0, i)]);  // they are all over memory
  }
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::flush(const Insertion& insertion) {
  Queue& queue = insertion.queue;
  for (std::size_t k = 0; k < queue.visits_waiting_; ++k) insert_in_line<Kind>(insertion, queue.visits_[k]);
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
    insert_in_line<Kind>(insertion, {Batch::sum(batch.entry, 0, 0, 0, i) | std::uint64_t{batch.bodies[i]} << kIdShift,
                                     Batch::sum(batch.query, 0, 0, 0, i) | kGuards,
                                     Batch::sum(batch.line, 0, 0, 0, i),
                                     {0, 0, 0}});
    rest[rests] = i;
    rests += batch.axes[i] != 0;
  }
  counts_.bodies += batch.count;
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
    const std::uint32_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const std::uint32_t line = Batch::sum(batch.line, x, y, z, i);
    prefetch(&lines_[line]);
    queue.visits_[queue.visits_waiting_++] = {
        Batch::sum(batch.entry, x, y, z, i) | id,
        Batch::sum(batch.query, x, y, z, i) | kGuards,
        line,
        {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(z)}};
  }
}

void SweptGrid::leave_many_visits(Queue& queue, BodyId body, const QuantumBox& box) const noexcept {
  Cell first, count;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = box.lower[d] >> kQuantumBits;
    count[d] = (box.upper[d] >> kQuantumBits) - first[d] + 1;
  }
  std::array<std::uint8_t, 3> steps;
  for (steps[2] = 0; steps[2] < count[2]; ++steps[2]) {
    for (steps[1] = 0; steps[1] < count[1]; ++steps[1]) {
      for (steps[0] = steps[1] == 0 && steps[2] == 0; steps[0] < count[0]; ++steps[0]) {
        const Cell cell = {first[0] + steps[0], first[1] + steps[1], first[2] + steps[2]};
        const Code code = code_of(box, cell);
        queue.visits_[queue.visits_waiting_++] = {code.entry | std::uint64_t{body} << kIdShift, code.query,
                                                  line_of(cell), steps};
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
