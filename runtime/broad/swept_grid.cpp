// More than 300 lines: one inner loop, compiled for each machine.
#include "swept_grid.h"

#include <bit>
#include <cstring>

#include "line_compare.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::uint32_t kEntryBits = 5, kFieldBits = kEntryBits + 1;
constexpr std::uint32_t kCoarser = kQuantumBits - kEntryBits;  // bits of a quantum that are left out of entries
constexpr std::uint32_t kLastInEntry = (1u << kEntryBits) - 1;
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

// A box clipped to a cell, in three fields each: how far it begins from the cell's lower end, and ends from its upper
// end. As a query these change places: two boxes meet if of each axis one's way to its begin and the other's from its
// end make less than a cell together.
ORCHARD_INLINE std::uint64_t entry_of(std::uint32_t from, std::uint32_t below) noexcept {
  return std::uint64_t{below} << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_from(std::uint64_t entry) noexcept {
  constexpr std::uint64_t field = (std::uint64_t{1} << 3 * kFieldBits) - 1;
  return (entry & field) << 3 * kFieldBits | (entry >> 3 * kFieldBits & field);
}

// A body's box, and one of its cells. Quanta are below 2^31: the difference of two that are apart is negative.
#ifdef ORCHARD_VECTORS
class BoxInCell {
 public:
  // In the fourth places there are numbers such that nothing is apart there, nor elsewhere.
  ORCHARD_INLINE BoxInCell(const QuantumBox& box, std::uint8_t steps) noexcept {
    constexpr std::uint32_t kAway = kLastQuantum;
    Numbers first, last;
    read(box, first, last);
    lower_ = __builtin_shufflevector(first, Numbers{kAway}, 0, 1, 2, 4);
    upper_ = __builtin_shufflevector(last, Numbers{kAway}, 1, 2, 3, 4);
    cell_ = (lower_ >> kQuantumBits) + load<Numbers>(kSteps[steps]);
    lower_last_ = __builtin_shufflevector(lower_, Numbers{}, 4, 0, 1, 2);
  }
  // Whether the other box meets it, and the lower corner of what they have in common lies in the cell.
  ORCHARD_INLINE bool meets_here(const QuantumBox& other) const noexcept {
    Numbers first, last;
    read(other, first, last);
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
  static constexpr auto kSteps = [] {  // along each axis
    std::array<std::array<std::uint32_t, 4>, 64> all{};
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = {i & 3, i >> 2 & 3, i >> 4, 0};
    return all;
  }();
  // lower[0], [1], [2], upper[0] and lower[2], upper[0], [1], [2]
  ORCHARD_INLINE static void read(const QuantumBox& box, Numbers& first, Numbers& last) noexcept {
    static_assert(offsetof(QuantumBox, upper) == 12 && sizeof(QuantumBox) == 24);
    std::memcpy(&first, &box, sizeof first);
    std::memcpy(&last, reinterpret_cast<const char*>(&box) + 8, sizeof last);
  }

  Numbers lower_, upper_, cell_, lower_last_;
};
#else
class BoxInCell {
 public:
  BoxInCell(const QuantumBox& box, std::uint8_t steps) noexcept : box_(box) {
    for (std::uint32_t d = 0; d < 3; ++d) cell_[d] = (box.lower[d] >> kQuantumBits) + (steps >> 2 * d & 3u);
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

}  // namespace

// What is found waits on the stack for room in the vector.
struct SweptGrid::Insertion {
  static constexpr std::size_t kFound = 256;

  std::span<const QuantumBox> boxes;
  std::vector<BodyPair>& pairs;
  GridCounts& counts;
  std::array<BodyPair, kFound> found;
  std::size_t count = 0;
  CellLine nowhere;  // for what has no room where it belongs

  Insertion(std::span<const QuantumBox> all, std::vector<BodyPair>& to, GridCounts& of) noexcept
      : boxes(all), pairs(to), counts(of) {}
  void hand_over() {
    if (count == 0) return;
    pairs.insert(pairs.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    counts.pairs += count;
    count = 0;
  }
};

// Of the entries hit, those whose box really meets the body's, and in this cell first. Without branches that depend on
// the boxes: in dense worlds nobody can tell.
void SweptGrid::report(Insertion& insertion, const CellLine& line, std::uint64_t hits, BodyIndex body, Steps steps) {
  const BoxInCell box(insertion.boxes[body], steps);
  if (insertion.count + line.entries.size() > Insertion::kFound) insertion.hand_over();
  std::size_t count = insertion.count;
  for (; hits != 0; hits &= hits - 1) {
    const std::uint64_t entry = line.entries[static_cast<std::size_t>(std::countr_zero(hits))];
    const auto other = static_cast<BodyIndex>(entry >> kIdShift);
    insertion.found[count] = {std::min(body, other), std::max(body, other)};
    count += box.meets_here(insertion.boxes[other]);
  }
  insertion.count = count;
}

// Where the line is full: in those that it overflows to.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_beyond(Insertion& insertion, const Visit& visit, std::uint64_t query) {
  CellLine* line = &lines_[visit.line];
  Overflow& overflow = overflow_[part_of(visit.line)];
  while (line->overflow != 0) {
    line = &overflow.lines[line->overflow - 1];
    ++insertion.counts.lines_read;
    const std::uint64_t met = Kind::meeting(*line, query);
    if (met != 0) report(insertion, *line, met, static_cast<BodyIndex>(visit.entry >> kIdShift), visit.steps);
  }
  if (line->count < line->entries.size()) {
    line->entries[line->count++] = visit.entry;
  } else {
    append(lines_[visit.line], visit.entry, overflow);
  }
}

// Loops without branches that depend on the data.
ORCHARD_INLINE void SweptGrid::encode(Batch& batch, std::span<const BodyIndex> bodies,
                                      const BoxBlock& block) const noexcept {
  const std::size_t lanes = lanes_for(bodies.size());
  Numbers all_from{}, all_below{}, all_line{}, axes{}, ids;
  std::uint32_t any = 0;
  batch.count = std::min(bodies.size(), kBlock);  // GCC does not know that there are no more
  for (std::size_t i = 0; i < batch.count; ++i) ids[i] = bodies[i];
  for (std::size_t i = batch.count; i < lanes; ++i) ids[i] = 0;
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t field = kFieldBits * d, factor = factors_[d];
    std::array<std::uint64_t, kBlock> change;
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::uint32_t lower = block.lower[d][i], upper = block.upper[d][i];
      const std::uint32_t cell = lower >> kQuantumBits, last = upper >> kQuantumBits;
      const std::uint32_t from = (lower >> kCoarser & kLastInEntry) << field,
                          below = (~upper >> kCoarser & kLastInEntry) << field;
      all_from[i] |= from;
      all_below[i] |= last > cell ? 0 : below;
      all_line[i] += cell * factor;
      axes[i] |= (last > cell ? 1u : 0u) << d | (last > cell + 1 ? 8u : 0u);
      change[i] = entry_of(from, below);
    }
    batch.change[d] = change;
  }
  for (std::size_t i = 0; i < lanes; ++i) {
    batch.entries[i] = entry_of(all_from[i], all_below[i]) | std::uint64_t{ids[i]} << kIdShift;
    batch.queries[i] = entry_of(all_below[i], all_from[i]);
  }
  for (std::size_t i = 0; i < lanes; ++i) batch.lines[i] = all_line[i] & mask_;
  for (std::size_t i = 0; i < lanes; ++i) batch.steps[i] = 0;
  for (std::size_t i = 0; i < lanes; ++i) any |= axes[i];
  batch.larges = 0;
  batch.end = batch.count;
  if ((any & 8) != 0) {
    for (std::size_t i = 0; i < batch.count; ++i) {
      batch.large[batch.larges] = ids[i];
      batch.larges += axes[i] >> 3;
      axes[i] = axes[i] >= 8 ? 0 : axes[i];
    }
  }
  if (any != 0) add_corners(batch, axes);
}

// As bits. The numbers are small.
ORCHARD_INLINE std::uint32_t SweptGrid::which_are_not_0(const Numbers& numbers, std::size_t lanes) noexcept {
  std::uint32_t bits = 0;
#if defined(ORCHARD_VECTORS) && defined(__SSE2__)
  using Four __attribute__((vector_size(16))) = std::uint32_t;
  for (std::size_t i = 0; i < lanes; i += 4) {
    Four four;
    std::memcpy(&four, &numbers[i], sizeof four);
    bits |= static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(-four))) << i;
  }
#else
  for (std::size_t i = 0; i < lanes; ++i) bits |= (numbers[i] != 0 ? 1u : 0u) << i;
#endif
  return bits;
}

// The other cells of bodies that take two along some axes: mostly it is one axis.
ORCHARD_INLINE void SweptGrid::add_corners(Batch& batch, const Numbers& axes) const noexcept {
  std::uint32_t several = which_are_not_0(axes, lanes_for(batch.count));
  if (batch.count < kBlock) several &= (1u << batch.count) - 1;
  std::size_t end = batch.end;
  for (; several != 0; several &= several - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(several));
    const std::uint32_t taken = axes[i];
    const auto add = [&](std::uint32_t corner) ORCHARD_INLINE_LAMBDA {  // which counts if it is taken
      std::uint64_t entry = batch.entries[i];
      std::uint32_t line = batch.lines[i], steps = 0;
      for (std::uint32_t d = 0; d < 3; ++d) {
        if ((corner >> d & 1) == 0) continue;
        entry ^= batch.change[d][i];
        line += factors_[d];
        steps |= 1u << 2 * d;
      }
      batch.entries[end] = entry;
      batch.queries[end] = query_from(entry);
      batch.lines[end] = line & mask_;
      batch.steps[end] = static_cast<Steps>(steps);
      end += (corner & ~taken) == 0;
    };
    add(1), add(2), add(4);
    if ((taken & (taken - 1)) != 0) add(3), add(5), add(6), add(7);
  }
  batch.end = end;
}

// At most Batch::kMaxVisits of them. What meets others, and what finds its line full, is put off until the rest is in:
// without branches, as in dense worlds nobody can tell. Entries stay where they are meanwhile.
template <typename Kind, typename Line, typename Entry, typename Query, typename Of>
ORCHARD_INLINE void SweptGrid::insert_visits(Insertion& insertion, std::size_t count, const Line& line_at,
                                             const Entry& entry_at, const Query& query_at, const Of& visit_at) {
  std::array<std::uint16_t, Batch::kMaxVisits + 1> meeting, full;
  std::array<std::uint8_t, Batch::kMaxVisits + 1> hits;
  std::size_t meetings = 0, fulls = 0;
  CellLine* const lines = lines_.data();
  CellLine& nowhere = insertion.nowhere;
  for (std::size_t k = 0; k < count; ++k) {
    CellLine& line = lines[line_at(k)];
    // Nothing is written before all seven entries have been read together: that would have to wait for the small
    // writes.
    const std::uint64_t met = Kind::meeting(line, query_at(k));
    const std::uint32_t filled = line.count;
    const bool room = filled < line.entries.size();
    *(room ? line.entries.data() + filled : nowhere.entries.data()) = entry_at(k);
    (room ? line : nowhere).count = filled + 1;
    hits[meetings] = static_cast<std::uint8_t>(met);
    meeting[meetings] = static_cast<std::uint16_t>(k);
    meetings += met != 0;
    full[fulls] = static_cast<std::uint16_t>(k);
    fulls += !room;
  }
  for (std::size_t i = 0; i < meetings; ++i) {
    const Visit visit = visit_at(meeting[i]);
    report(insertion, lines[visit.line], hits[i], static_cast<BodyIndex>(visit.entry >> kIdShift), visit.steps);
  }
  for (std::size_t i = 0; i < fulls; ++i) insert_beyond<Kind>(insertion, visit_at(full[i]), query_at(full[i]));
  insertion.counts.entries += count;
  insertion.counts.lines_read += count;
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_batch(Insertion& insertion, const Batch& batch) {
  const std::uint32_t* const lines = batch.lines.data();
  const std::uint64_t *const entries = batch.entries.data(), *const queries = batch.queries.data();
  const auto line_at = [=](std::size_t k) ORCHARD_INLINE_LAMBDA { return lines[k]; };
  const auto entry_at = [=](std::size_t k) ORCHARD_INLINE_LAMBDA { return entries[k]; };
  const auto query_at = [=](std::size_t k) ORCHARD_INLINE_LAMBDA { return queries[k]; };
  const auto visit_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA {
    return Visit{batch.entries[k], batch.lines[k], batch.steps[k]};
  };
  insert_visits<Kind>(insertion, batch.end, line_at, entry_at, query_at, visit_at);
  insertion.counts.bodies += batch.count;
  if (batch.larges > 0) insert_large<Kind>(insertion, batch);
}

// In all cells but the first one.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_large(Insertion& insertion, const Batch& batch) {
  std::array<Visit, kMaxVisits> visits;
  for (std::size_t i = 0; i < batch.larges; ++i) {
    const BodyIndex body = batch.large[i];
    const Visit* const end = many_visits_of(body, insertion.boxes[body], visits.data());
    for (const Visit* visit = visits.data(); visit != end; ++visit) prefetch(&lines_[visit->line]);
    insert_visits<Kind>(insertion, std::span(visits.data(), end));
  }
}

SweptGrid::Visit* SweptGrid::many_visits_of(BodyIndex body, const QuantumBox& box, Visit* visits) const noexcept {
  Cell first, count;
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = box.lower[d] >> kQuantumBits;
    count[d] = (box.upper[d] >> kQuantumBits) - first[d] + 1;
  }
  Cell steps;
  for (steps[2] = 0; steps[2] < count[2]; ++steps[2]) {
    for (steps[1] = 0; steps[1] < count[1]; ++steps[1]) {
      for (steps[0] = steps[1] == 0 && steps[2] == 0; steps[0] < count[0]; ++steps[0]) {
        const Cell cell = {first[0] + steps[0], first[1] + steps[1], first[2] + steps[2]};
        std::uint32_t from = 0, below = 0;
        for (std::uint32_t i = 0; i < 3; ++i) {
          const std::uint32_t begin = cell[i] << kQuantumBits, end = begin + (kQuanta - 1);
          from |= (box.lower[i] > begin ? (box.lower[i] - begin) >> kCoarser : 0) << kFieldBits * i;
          below |= (box.upper[i] < end ? (end - box.upper[i]) >> kCoarser : 0) << kFieldBits * i;
        }
        *visits++ = {entry_of(from, below) | std::uint64_t{body} << kIdShift, line_of(cell),
                     static_cast<Steps>(steps[0] | steps[1] << 2 | steps[2] << 4)};
      }
    }
  }
  return visits;
}

// block null: the last ones get in.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::advance(Insertion& insertion, Queue& queue, std::span<const BodyIndex> bodies,
                                       const BoxBlock* block) {
  Batch &next = queue.batches_[1 - queue.current_], &waiting = queue.batches_[queue.current_];
  if (block != nullptr) {
    encode(next, bodies, *block);
    for (std::size_t i = 0; i < next.end; ++i) prefetch(&lines_[next.lines[i]]);  // they are all over memory
  }
  insert_batch<Kind>(insertion, waiting);
  if (block != nullptr) {
    queue.current_ = 1 - queue.current_;
  } else {
    waiting.count = waiting.end = waiting.larges = 0;
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
  for (Visits& part : visits) part.make_room(batch.end);
  for (std::size_t k = 0; k < batch.end; ++k) {
    visits[part_of(batch.lines[k])].add({batch.entries[k], batch.lines[k], batch.steps[k]});
  }
  std::array<Visit, kMaxVisits> rest;
  for (std::size_t i = 0; i < batch.larges; ++i) {
    const Visit* const end = many_visits_of(batch.large[i], boxes[batch.large[i]], rest.data());
    for (Visits& part : visits) part.make_room(kMaxVisits);
    for (const Visit* visit = rest.data(); visit != end; ++visit) visits[part_of(visit->line)].add(*visit);
  }
}

void SweptGrid::scatter(std::span<const BodyIndex> bodies, const BoxBlock& block, std::span<const QuantumBox> boxes,
                        bool vectors, VisitsByPart& visits) const {
  if (!vectors) return scatter_block(bodies, block, boxes, visits);
  per_machine([&]() ORCHARD_INLINE_LAMBDA { scatter_block(bodies, block, boxes, visits); });
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_visits(Insertion& insertion, std::span<const Visit> visits) {
  constexpr std::size_t kAhead = 32;
  for (; !visits.empty(); visits = visits.subspan(std::min(visits.size(), Batch::kMaxVisits))) {
    const auto line_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA {
      if (k + kAhead < visits.size()) prefetch(&lines_[visits[k + kAhead].line]);
      return visits[k].line;
    };
    const auto entry_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return visits[k].entry; };
    const auto query_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return query_from(visits[k].entry); };
    const auto visit_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return visits[k]; };
    insert_visits<Kind>(insertion, std::min(visits.size(), Batch::kMaxVisits), line_at, entry_at, query_at, visit_at);
  }
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
