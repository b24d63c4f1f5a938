// More than 300 lines: one inner loop, compiled for each machine.
#include "swept_grid.h"

#include <bit>
#include <cstring>

#include "line_compare.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint32_t kFieldBits = kQuantumBits + 1;
constexpr std::uint32_t kMaxEntry = 0x1f7dfu;  // three fields, each of them kQuanta - 1
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

// A box clipped to a cell, in three fields each: how far it begins from the cell's lower end, and ends from its upper
// end. As an entry or as a query: entry's field <= query's field in all six means that they meet.
ORCHARD_INLINE std::uint64_t entry_of(std::uint32_t from, std::uint32_t below) noexcept {
  return std::uint64_t{below} << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_of(std::uint32_t from, std::uint32_t below) noexcept {
  return entry_of(kMaxEntry - below, kMaxEntry - from) | kGuards;
}

ORCHARD_INLINE std::uint64_t query_from(std::uint64_t entry) noexcept {
  constexpr std::uint64_t field = (std::uint64_t{1} << 3 * kFieldBits) - 1;
  return query_of(static_cast<std::uint32_t>(entry & field),
                  static_cast<std::uint32_t>(entry >> 3 * kFieldBits & field));
}

// A body's box, and one of its cells. Quanta are below 2^31: the difference of two that are apart is negative.
#ifdef ORCHARD_VECTORS
class BoxInCell {
 public:
  ORCHARD_INLINE BoxInCell(const QuantumBox& box, const std::array<std::uint8_t, 3>& steps) noexcept {
    for (std::size_t d = 0; d < 3; ++d) {
      lower_[d] = box.lower[d];
      upper_[d] = box.upper[d];
      cell_[d] = (box.lower[d] >> kQuantumBits) + steps[d];
    }
    lower_[3] = upper_[3] = kLastQuantum;  // the fourth numbers: such that nothing is apart there, nor elsewhere
    cell_[3] = kLastQuantum >> kQuantumBits;
    lower_last_ = __builtin_shufflevector(lower_, Numbers{}, 4, 0, 1, 2);
  }
  // Whether the other box meets it, and the lower corner of what they have in common lies in the cell.
  ORCHARD_INLINE bool meets_here(const QuantumBox& other) const noexcept {
    static_assert(offsetof(QuantumBox, upper) == 12 && sizeof(QuantumBox) == 24);
    Numbers first, last;  // lower[0], [1], [2], upper[0] and lower[2], upper[0], [1], [2]
    std::memcpy(&first, &other, sizeof first);
    std::memcpy(&last, reinterpret_cast<const char*>(&other) + 8, sizeof last);
    const Numbers apart = (upper_ - first) | (last - lower_last_);
    const auto larger = reinterpret_cast<Signed>(lower_) > reinterpret_cast<Signed>(first);
    const Numbers corner = larger ? lower_ : first;
    const Numbers wrong = (apart & 0x80000000u) | ((corner >> kQuantumBits) ^ cell_);
    const auto halves = reinterpret_cast<Halves>(wrong);
    return (halves[0] | halves[1]) == 0;
  }

 private:
  using Numbers __attribute__((vector_size(16))) = std::uint32_t;
  using Signed __attribute__((vector_size(16))) = std::int32_t;
  using Halves __attribute__((vector_size(16))) = std::uint64_t;
  Numbers lower_, upper_, cell_, lower_last_;
};
#else
class BoxInCell {
 public:
  BoxInCell(const QuantumBox& box, const std::array<std::uint8_t, 3>& steps) noexcept : box_(box) {
    for (std::size_t d = 0; d < 3; ++d) cell_[d] = (box.lower[d] >> kQuantumBits) + steps[d];
  }
  bool meets_here(const QuantumBox& other) const noexcept {
    std::uint32_t apart = 0, elsewhere = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      apart |= (other.upper[d] - box_.lower[d]) | (box_.upper[d] - other.lower[d]);
      elsewhere |= (std::max(box_.lower[d], other.lower[d]) >> kQuantumBits) ^ cell_[d];
    }
    return (apart >> 31 | elsewhere) == 0;
  }

 private:
  const QuantumBox box_;
  std::array<std::uint32_t, 3> cell_;
};
#endif

// The bits of the first entries: the others are of no meaning.
template <typename Kind>
ORCHARD_INLINE std::uint64_t met_among(const CellLine& line, std::uint64_t query, std::uint32_t count) noexcept {
  return Kind::meeting(line, query) & ((std::uint64_t{1} << (Kind::kSpread * static_cast<int>(count))) - 1);
}

}  // namespace

// What is found waits on the stack for room in the vector.
struct SweptGrid::Insertion {
  static constexpr std::size_t kFound = 256;

  std::span<const QuantumBox> boxes;
  std::vector<BodyPair>& pairs;
  GridCounts& counts;
  std::array<BodyPair, kFound> found;
  std::size_t count = 0;

  Insertion(std::span<const QuantumBox> all, std::vector<BodyPair>& to, GridCounts& of) noexcept
      : boxes(all), pairs(to), counts(of) {}
  void hand_over() {
    pairs.insert(pairs.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    counts.pairs += count;
    count = 0;
  }
};

// Of the entries hit, those whose box really meets the body's, and in this cell first. Without branches that depend on
// the boxes: in dense worlds nobody can tell.
template <int kSpread>
void SweptGrid::report(Insertion& insertion, const CellLine& line, std::uint64_t hits, BodyIndex body, Steps steps) {
  const BoxInCell box(insertion.boxes[body], steps);
  if (insertion.count + line.entries.size() > Insertion::kFound) insertion.hand_over();
  std::size_t count = insertion.count;
  for (; hits != 0; hits &= hits - 1) {
    const std::uint64_t entry = line.entries[static_cast<std::size_t>(std::countr_zero(hits)) / kSpread];
    const auto other = static_cast<BodyIndex>(entry >> kIdShift);
    insertion.found[count] = {std::min(body, other), std::max(body, other)};
    count += box.meets_here(insertion.boxes[other]);
  }
  insertion.count = count;
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_in_line(Insertion& insertion, const Visit& visit, std::uint64_t query) {
  // Nothing is written before all seven entries have been read together: that would have to wait for the small writes.
  CellLine& first = lines_[visit.line];
  const auto body = static_cast<BodyIndex>(visit.entry >> kIdShift);
  const std::uint32_t count = first.count, more = first.overflow;
  const std::uint64_t hits = met_among<Kind>(first, query, count);
  if (hits != 0) report<Kind::kSpread>(insertion, first, hits, body, visit.steps);
  if (more == 0 && count < first.entries.size()) [[likely]] {
    first.entries[count] = visit.entry;
    first.count = count + 1;
    return;
  }
  Overflow& overflow = overflow_[part_of(visit.line)];
  for (std::uint32_t next = more; next != 0;) {
    const CellLine& line = overflow.lines[next - 1];
    ++insertion.counts.lines_read;
    const std::uint64_t met = met_among<Kind>(line, query, line.count);
    if (met != 0) report<Kind::kSpread>(insertion, line, met, body, visit.steps);
    next = line.overflow;
  }
  append(first, visit.entry, overflow);
}

// Loops without branches that depend on the data.
ORCHARD_INLINE void SweptGrid::encode(Batch& batch, std::span<const BodyIndex> bodies,
                                      const BoxBlock& block) const noexcept {
  using Numbers = std::array<std::uint32_t, kBlock>;
  const std::size_t lanes = lanes_for(bodies.size());
  Numbers all_from{}, all_below{}, all_line{}, axes{};
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t field = kFieldBits * d, factor = factors_[d];
    Numbers from, below, line, next_below, next_line;
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint32_t lower = block.lower[d][i], upper = block.upper[d][i];
      const std::uint32_t cell = lower >> kQuantumBits, last = upper >> kQuantumBits;
      from[i] = (lower & (kQuanta - 1)) << field;
      next_below[i] = (~upper & (kQuanta - 1)) << field;
      below[i] = last > cell ? 0 : next_below[i];
      line[i] = cell * factor;
      next_line[i] = last * factor;
      axes[i] |= (last > cell ? 1u : 0u) << d | (last > cell + 1 ? 8u : 0u);
      all_from[i] |= from[i];
      all_below[i] |= below[i];
      all_line[i] += line[i];
    }
    batch.from[d] = from;
    batch.below[0][d] = below, batch.below[1][d] = next_below;
    batch.lines[0][d] = line, batch.lines[1][d] = next_line;
  }
  batch.axes = axes;
  for (std::size_t i = 0; i < lanes; ++i) batch.line[i] = all_line[i] & mask_;
  batch.count = std::min(bodies.size(), kBlock);  // GCC does not know that there are no more
  for (std::size_t i = 0; i < batch.count; ++i) {
    batch.bodies[i] = bodies[i];
    batch.entry[i] = entry_of(all_from[i], all_below[i]) | std::uint64_t{bodies[i]} << kIdShift;
    batch.query[i] = query_of(all_from[i], all_below[i]);
  }
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::flush(Insertion& insertion, Queue& queue) {
  for (std::size_t k = 0; k < queue.visits_waiting_; ++k) {
    insert_in_line<Kind>(insertion, queue.visits_[k], query_from(queue.visits_[k].entry));
  }
  insertion.counts.entries += queue.visits_waiting_;
  insertion.counts.lines_read += queue.visits_waiting_;
  queue.visits_waiting_ = 0;
}

// The batch that waited: first every body in its first cell, then the visits left from the batch before; bodies that
// take several cells leave visits to the others.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_waiting(Insertion& insertion, Queue& queue) {
  const Batch& batch = queue.batches_[queue.current_];
  std::array<std::uint32_t, kBlock> rest;
  std::size_t rests = 0;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    insert_in_line<Kind>(insertion, {batch.entry[i], batch.line[i], {0, 0, 0}}, batch.query[i]);
    rest[rests] = i;
    rests += batch.axes[i] != 0;
  }
  insertion.counts.bodies += batch.count;
  insertion.counts.entries += batch.count;
  insertion.counts.lines_read += batch.count;
  flush<Kind>(insertion, queue);
  for (std::size_t k = 0; k < rests; ++k) {
    if (queue.visits_waiting_ + kMaxVisits > queue.visits_.size()) flush<Kind>(insertion, queue);
    Visit* const begin = queue.visits_.data() + queue.visits_waiting_;
    const Visit* const end = visits_of(batch, rest[k], insertion.boxes, begin);
    for (const Visit* visit = begin; visit != end; ++visit) prefetch(&lines_[visit->line]);
    queue.visits_waiting_ += static_cast<std::size_t>(end - begin);
  }
}

// To all cells of a body's box but the first; returns where they end.
ORCHARD_INLINE SweptGrid::Visit* SweptGrid::visits_of(const Batch& batch, std::uint32_t i,
                                                      std::span<const QuantumBox> boxes, Visit* visits) const noexcept {
  const std::uint32_t axes = batch.axes[i];
  if (axes >= 8) return many_visits_of(batch.bodies[i], boxes[batch.bodies[i]], visits);
  const std::uint64_t id = std::uint64_t{batch.bodies[i]} << kIdShift;
  for (std::uint32_t corner = axes; corner != 0; corner = (corner - 1) & axes) {
    const Steps steps = {static_cast<std::uint8_t>(corner & 1), static_cast<std::uint8_t>(corner >> 1 & 1),
                         static_cast<std::uint8_t>(corner >> 2)};
    std::uint32_t from = 0, below = 0, line = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      if (steps[d] == 0) from |= batch.from[d][i];
      below |= batch.below[steps[d]][d][i];
      line += batch.lines[steps[d]][d][i];
    }
    *visits++ = {entry_of(from, below) | id, line & mask_, steps};
  }
  return visits;
}

SweptGrid::Visit* SweptGrid::many_visits_of(BodyIndex body, const QuantumBox& box, Visit* visits) const noexcept {
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
        *visits++ = {entry_of(from, below) | std::uint64_t{body} << kIdShift, line_of(cell), steps};
      }
    }
  }
  return visits;
}

// block null: the last ones get in.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::advance(Insertion& insertion, Queue& queue, std::span<const BodyIndex> bodies,
                                       const BoxBlock* block) {
  Batch& next = queue.batches_[1 - queue.current_];
  if (block != nullptr) {
    encode(next, bodies, *block);
    for (std::size_t i = 0; i < next.count; ++i) prefetch(&lines_[next.line[i]]);  // they are all over memory
  }
  insert_waiting<Kind>(insertion, queue);
  if (block != nullptr) {
    queue.current_ = 1 - queue.current_;
  } else {
    flush<Kind>(insertion, queue);
    queue.batches_[queue.current_].count = 0;
  }
}

void SweptGrid::run(Queue& queue, std::span<const BodyIndex> bodies, const BoxBlock* block,
                    std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  Insertion insertion(boxes, pairs, counts_);
  if (vectors) {
    with_best_compare([&]<typename Kind>() ORCHARD_INLINE_LAMBDA { advance<Kind>(insertion, queue, bodies, block); });
  } else {
    advance<PlainCompare>(insertion, queue, bodies, block);
  }
  insertion.hand_over();
}

void SweptGrid::insert(Queue& queue, std::span<const BodyIndex> bodies, const BoxBlock& block,
                       std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  run(queue, bodies, &block, boxes, vectors, pairs);
}

void SweptGrid::finish(Queue& queue, std::span<const QuantumBox> boxes, bool vectors, std::vector<BodyPair>& pairs) {
  run(queue, {}, nullptr, boxes, vectors, pairs);
}

ORCHARD_INLINE void SweptGrid::scatter_block(std::span<const BodyIndex> bodies, const BoxBlock& block,
                                             std::span<const QuantumBox> boxes, VisitsByPart& visits) const {
  Batch batch;
  encode(batch, bodies, block);
  std::array<Visit, kMaxVisits> rest;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    visits[part_of(batch.line[i])].push_back({batch.entry[i], batch.line[i], {0, 0, 0}});
    if (batch.axes[i] == 0) continue;
    const Visit* const end = visits_of(batch, i, boxes, rest.data());
    for (const Visit* visit = rest.data(); visit != end; ++visit) visits[part_of(visit->line)].push_back(*visit);
  }
}

void SweptGrid::scatter(std::span<const BodyIndex> bodies, const BoxBlock& block, std::span<const QuantumBox> boxes,
                        bool vectors, VisitsByPart& visits) const {
  if (!vectors) return scatter_block(bodies, block, boxes, visits);
  per_machine([&]() ORCHARD_INLINE_LAMBDA { scatter_block(bodies, block, boxes, visits); });
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_visits(Insertion& insertion, std::span<const Visit> visits) {
  constexpr std::size_t kAhead = 8;
  for (std::size_t k = 0; k < visits.size(); ++k) {
    if (k + kAhead < visits.size()) prefetch(&lines_[visits[k + kAhead].line]);
    const Visit& visit = visits[k];
    insert_in_line<Kind>(insertion, visit, query_from(visit.entry));
  }
  insertion.counts.entries += visits.size();
  insertion.counts.lines_read += visits.size();
}

void SweptGrid::insert_part(std::span<const Visit> visits, std::span<const QuantumBox> boxes, bool vectors,
                            std::vector<BodyPair>& pairs, GridCounts& counts) {
  Insertion insertion(boxes, pairs, counts);
  if (vectors) {
    with_best_compare([&]<typename Kind>() ORCHARD_INLINE_LAMBDA { insert_visits<Kind>(insertion, visits); });
  } else {
    insert_visits<PlainCompare>(insertion, visits);
  }
  insertion.hand_over();
}

void SweptGrid::count(const GridCounts& counts) noexcept {
  counts_.bodies += counts.bodies;
  counts_.entries += counts.entries;
  counts_.lines_read += counts.lines_read;
  counts_.pairs += counts.pairs;
}

}  // namespace orchard::runtime::detail
