#include "broad_phase/swept_grid.h"

#include <bit>
#include <cstring>

#include "broad_phase/cell_entry.h"
#include "broad_phase/line_compare.h"

namespace orchard::runtime::detail {
namespace {

// A body's box, and one of its cells. Quanta are below 2^31: the difference of two that are apart is negative.
#ifdef ORCHARD_VECTORS
class BoxInCell {
 public:
  // In the fourth places there are zeros: nothing is apart there, nor elsewhere.
  ORCHARD_INLINE BoxInCell(const PackedAabb& box, std::uint8_t steps) noexcept {
    read(box, lower_, upper_);
    cell_ = (lower_ >> kQuantumBits) + load<Numbers>(kSteps[steps]);
  }
  // Whether the other box meets it, and the lower corner of what they have in common lies in the cell.
  ORCHARD_INLINE bool meets_here(const PackedAabb& other) const noexcept {
    Numbers lower, upper;
    read(other, lower, upper);
    const Numbers apart = (upper_ - lower) | (upper - lower_);
    const auto larger = reinterpret_cast<Signed>(lower_) > reinterpret_cast<Signed>(lower);
    const Numbers corner = larger ? lower_ : lower;
    const Numbers wrong = (apart & 0x80000000u) | ((corner >> kQuantumBits) ^ cell_);
    const auto halves = reinterpret_cast<Halves>(wrong);
    return (halves[0] | halves[1]) == 0;
  }

 private:
  using Numbers __attribute__((vector_size(16))) = std::uint32_t;
  using Signed __attribute__((vector_size(16))) = std::int32_t;
  using Halves __attribute__((vector_size(16))) = std::uint64_t;
  using Bytes __attribute__((vector_size(16))) = std::uint8_t;
  using Shorts __attribute__((vector_size(16))) = std::uint16_t;
  static constexpr auto kSteps = [] {  // along each axis
    std::array<std::array<std::uint32_t, 4>, 64> all{};
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = {i & 3, i >> 2 & 3, i >> 4, 0};
    return all;
  }();
  ORCHARD_INLINE static void read(const PackedAabb& box, Numbers& lower, Numbers& upper) noexcept {
    static_assert(offsetof(PackedAabb, lengths) == 12 && sizeof(PackedAabb) == sizeof lower);
    Numbers all;
    std::memcpy(&all, &box, sizeof all);
    lower = all & Numbers{~0u, ~0u, ~0u, 0};
    // The last four bytes, each as a number, by what is one instruction each; the fourth one is 0.
    const Shorts shorts = reinterpret_cast<Shorts>(__builtin_shufflevector(
        reinterpret_cast<Bytes>(all), Bytes{}, 8, 16, 9, 17, 10, 18, 11, 19, 12, 20, 13, 21, 14, 22, 15, 23));
    const Shorts lengths = __builtin_shufflevector(shorts, Shorts{}, 4, 8, 5, 9, 6, 10, 7, 11);
    upper = lower + reinterpret_cast<Numbers>(lengths);
  }

  Numbers lower_, upper_, cell_;
};
#else
class BoxInCell {
 public:
  BoxInCell(const PackedAabb& box, std::uint8_t steps) noexcept : box_(box.whole()) {
    for (std::uint32_t d = 0; d < 3; ++d) cell_[d] = (box.lower[d] >> kQuantumBits) + (steps >> 2 * d & 3u);
  }
  bool meets_here(const PackedAabb& narrow) const noexcept {
    const QuantizedAabb other = narrow.whole();
    std::uint32_t apart = 0, elsewhere = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      apart |= (other.upper[d] - box_.lower[d]) | (box_.upper[d] - other.lower[d]);
      elsewhere |= (std::max(box_.lower[d], other.lower[d]) >> kQuantumBits) ^ cell_[d];
    }
    return (apart >> 31 | elsewhere) == 0;
  }

 private:
  const QuantizedAabb box_;
  std::array<std::uint32_t, 3> cell_;
};
#endif

// False, and it stays as it is, if it is full. Without a branch: what has no room is written where the counters are,
// which are written again.
ORCHARD_INLINE bool put(CellLine& line, std::uint64_t entry) noexcept {
  constexpr std::size_t kRoom = std::tuple_size_v<decltype(line.entries)>;
  constexpr int kCountAt = std::endian::native == std::endian::little ? 0 : 32;  // among the counters' bits
  static_assert(offsetof(CellLine, count) == sizeof line.entries &&
                offsetof(CellLine, overflow) == offsetof(CellLine, count) + 4);
  auto* const bytes = reinterpret_cast<unsigned char*>(&line);
  std::uint64_t counters;
  std::memcpy(&counters, bytes + sizeof line.entries, sizeof counters);
  const std::uint32_t count = static_cast<std::uint32_t>(counters >> kCountAt);
  const std::uint64_t room = count < kRoom ? 1 : 0;
  std::memcpy(bytes + std::size_t{count} * sizeof entry, &entry, sizeof entry);
  counters += room << kCountAt;
  std::memcpy(bytes + sizeof line.entries, &counters, sizeof counters);
  return room != 0;
}

}  // namespace

// What is found waits on the stack for room in the vector.
struct SweptGrid::Insertion {
  static constexpr std::size_t kFound = 256;

  std::span<const PackedAabb> boxes;
  std::vector<BodyPair>& pairs;
  GridCounts& counts;
  std::array<BodyPair, kFound> found;
  std::size_t count = 0;

  Insertion(std::span<const PackedAabb> all, std::vector<BodyPair>& to, GridCounts& of) noexcept
      : boxes(all), pairs(to), counts(of) {}
  void hand_over() {
    if (count == 0) return;
    pairs.insert(pairs.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    counts.pairs += count;
    count = 0;
  }
};

// Of the entries hit, those whose box really meets the body's, and in this cell first. Without branches that depend on
// the boxes: in dense worlds no branch can be predicted.
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
ORCHARD_INLINE void SweptGrid::insert_beyond(Insertion& insertion, const Visit& visit) {
  const std::uint64_t query = query_from(visit.entry);
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

// What is put off until the rest of some visits is in: those that meet others, and those that find their line full.
struct SweptGrid::PutOff {
  static constexpr unsigned kHitsAt = 16;  // bits, above the visit's number

  std::array<std::uint32_t, Batch::kMaxVisits + 1> meeting;  // what does not count is written, too
  std::array<std::uint16_t, Batch::kMaxVisits + 1> full;
  std::size_t meetings, fulls;
};

// Without branches, as in dense worlds no branch can be predicted.
template <typename Kind, typename Line, typename Entry, typename Query>
ORCHARD_INLINE void SweptGrid::put_all(PutOff& put_off, std::size_t count, const Line& line_at, const Entry& entry_at,
                                       const Query& query_at) noexcept {
  std::size_t meetings = 0, fulls = 0;
  CellLine* const lines = lines_.data();
  for (std::size_t k = 0; k < count; ++k) {
    CellLine& line = lines[line_at(k)];
    // Nothing is written before all seven entries have been read together: that would have to wait for the small
    // writes.
    const std::uint64_t met = Kind::meeting(line, query_at(k));
    const bool room = put(line, entry_at(k));
    put_off.meeting[meetings] = static_cast<std::uint32_t>(k | met << PutOff::kHitsAt);
    meetings += met != 0;
    put_off.full[fulls] = static_cast<std::uint16_t>(k);
    fulls += !room;
  }
  put_off.meetings = meetings;
  put_off.fulls = fulls;
}

// Entries stay where they are meanwhile.
template <typename Of>
void SweptGrid::finish_visits(Insertion& insertion, const PutOff& put_off, const Of& visit_at) {
  for (std::size_t i = 0; i < put_off.meetings; ++i) {
    const Visit visit = visit_at(put_off.meeting[i] & ((1u << PutOff::kHitsAt) - 1));
    report(insertion, lines_[visit.line], put_off.meeting[i] >> PutOff::kHitsAt,
           static_cast<BodyIndex>(visit.entry >> kIdShift), visit.steps);
  }
  if (put_off.fulls > 0) {
    with_best_compare([&]<typename Kind>() ORCHARD_INLINE_LAMBDA {
      for (std::size_t i = 0; i < put_off.fulls; ++i) insert_beyond<Kind>(insertion, visit_at(put_off.full[i]));
    });
  }
}

void SweptGrid::insert(const Batch& batch, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
                       GridCounts& counts) {
  Insertion insertion(boxes, pairs, counts);
  PutOff put_off;
  counts.entries += batch.end;
  counts.lines_read += batch.end;
  with_best_compare([&]<typename Kind>() ORCHARD_INLINE_LAMBDA {
    const std::uint32_t* const lines = batch.lines.data();
    const std::uint64_t *const entries = batch.entries.data(), *const queries = batch.queries.data();
    const auto line_at = [=](std::size_t k) ORCHARD_INLINE_LAMBDA { return lines[k]; };
    const auto entry_at = [=](std::size_t k) ORCHARD_INLINE_LAMBDA { return entries[k]; };
    const auto query_at = [=](std::size_t k) ORCHARD_INLINE_LAMBDA { return queries[k]; };
    put_all<Kind>(put_off, batch.end, line_at, entry_at, query_at);
  });
  finish_visits(insertion, put_off, [&](std::size_t k) {
    return Visit{batch.entries[k], batch.lines[k], batch.steps[k]};
  });
  std::array<Visit, kMaxVisits> rest;  // of what takes many cells, all but the first one
  for (std::size_t i = 0; i < batch.larges; ++i) {
    const Visit* const end = many_visits_of(batch.large[i], boxes[batch.large[i]].whole(), rest.data());
    insert_visits(insertion, std::span<const Visit>(rest.data(), end));
  }
  insertion.hand_over();
}

void SweptGrid::scatter(std::span<const BodyIndex> bodies, const BoxBlock& block, std::span<const PackedAabb> boxes,
                        VisitsByPart& visits) const {
  Batch batch;
  std::array<Visit, kMaxVisits> rest;
  for (std::size_t first = 0; first < bodies.size(); first += kBatch) {
    encode(batch, bodies.subspan(first, std::min(kBatch, bodies.size() - first)), block, first);
    std::array<Visit*, kParts> ends;  // by themselves: what is written might be the vectors
    for (std::size_t i = 0; i < kParts; ++i) {
      visits[i].make_room(batch.end);
      ends[i] = visits[i].end();
    }
    const unsigned shift = part_shift_;
    for (std::size_t k = 0; k < batch.end; ++k) {
      Visit*& end = ends[batch.lines[k] >> shift];
      *end++ = {batch.entries[k], batch.lines[k], batch.steps[k]};
    }
    for (std::size_t i = 0; i < kParts; ++i) visits[i].end_at(ends[i]);
    for (std::size_t i = 0; i < batch.larges; ++i) {
      const Visit* const end = many_visits_of(batch.large[i], boxes[batch.large[i]].whole(), rest.data());
      for (Visits& part : visits) part.make_room(kMaxVisits);
      for (const Visit* visit = rest.data(); visit != end; ++visit) visits[part_of(visit->line)].add(*visit);
    }
  }
}

void SweptGrid::insert_visits(Insertion& insertion, std::span<const Visit> visits) {
  constexpr std::size_t kAhead = 32;
  PutOff put_off;
  insertion.counts.entries += visits.size();
  insertion.counts.lines_read += visits.size();
  for (; !visits.empty(); visits = visits.subspan(std::min(visits.size(), Batch::kMaxVisits))) {
    const std::size_t count = std::min(visits.size(), Batch::kMaxVisits);
    with_best_compare([&]<typename Kind>() ORCHARD_INLINE_LAMBDA {
      const Visit* const all = visits.data();
      const std::size_t size = visits.size();
      const auto line_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA {
        if (k + kAhead < size) prefetch(&lines_[all[k + kAhead].line]);
        return all[k].line;
      };
      const auto entry_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return all[k].entry; };
      const auto query_at = [&](std::size_t k) ORCHARD_INLINE_LAMBDA { return query_from(all[k].entry); };
      put_all<Kind>(put_off, count, line_at, entry_at, query_at);
    });
    finish_visits(insertion, put_off, [&](std::size_t k) { return visits[k]; });
  }
}

void SweptGrid::insert(std::span<const Visit> visits, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
                       GridCounts& counts) {
  Insertion insertion(boxes, pairs, counts);
  insert_visits(insertion, visits);
  insertion.hand_over();
}

}  // namespace orchard::runtime::detail
