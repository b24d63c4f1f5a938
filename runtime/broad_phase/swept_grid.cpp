#include "broad_phase/swept_grid.h"

#include <cassert>

#include "broad_phase/cell_line.h"
#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

// The factors of the second and the third coordinate of a cell, for tables of 2^6 lines, 2^7 and so on; the first
// coordinate is added as it is. They were found by a random search, so that cells that share a line lie far apart:
// about as far as is possible in space, and in each plane of two axes from 2^10 lines on, but nowhere less than four
// cells along some axis, so that the cells of one body never share a line.
constexpr std::array<std::array<std::uint32_t, 2>, kMaxLineBits - kMinLineBits + 1> kLineFactors = {{
    {4u, 16u},
    {25u, 5u},
    {13u, 173u},
    {455u, 81u},
    {417u, 595u},
    {555u, 1525u},
    {2269u, 1477u},
    {4561u, 1073u},
    {14965u, 12261u},
    {615u, 29187u},
    {20841u, 50579u},
    {53795u, 31159u},
    {226939u, 254255u},
    {257047u, 373547u},
    {473433u, 491881u},
    {1623247u, 1298969u},
    {705049u, 2785325u},
    {6477005u, 1636555u},
    {8975075u, 10600377u},
    {20366405u, 28785053u},
    {51419493u, 5405973u},
    {14447183u, 113607059u},
    {47377195u, 86274897u},
}};

// Returns a table by the neighbours of a cell that lie further along some axes, with a bit for each of these axes. It
// has the sum of of(d) over them.
template <typename Of>
constexpr std::array<std::uint32_t, 8> by_corner(const Of& of) noexcept {
  std::array<std::uint32_t, 8> all{};
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    for (std::uint32_t d = 0; d < 3; ++d) all[corner] += (corner >> d & 1) * of(d);
  }
  return all;
}
// For a box that goes on to a neighbour: the fields of its lower ends that are 0 there, and the steps to there.
constexpr auto kFieldsOf = by_corner([](std::uint32_t d) { return kLastInEntry << kFieldBits * d; });
constexpr auto kStepsOf = by_corner([](std::uint32_t d) { return 1u << 2 * d; });

// The boxes of the bodies of a block in their first cells.
struct Coded {
  using Numbers = std::array<std::uint32_t, kBlock>;
  Numbers from, below;                        // fields, as of a box that takes one cell
  Numbers beyond;                             // the fields of the axes along which the box takes the next cell, too
  Numbers lines;                              // the lines of the first cells, not masked yet
  Numbers axes;                               // a bit for each of these axes; bit 3: more than two cells along an axis
  std::array<std::uint64_t, kBlock> entries;  // in the first cells
  std::uint32_t cells;                        // the number that all boxes take together
};

// Computes `coded`. The loop has no branches that depend on the data.
ORCHARD_INLINE void code(Coded& coded, const BoxBlock& block, std::span<const BodyIndex> bodies,
                         const std::array<std::uint32_t, 3>& factors) noexcept {
  const std::size_t count = std::min(bodies.size(), kBlock);  // GCC does not know that there are no more
  std::uint32_t cells = 0;
  for (std::size_t i = 0; i < lanes_for(count); ++i) {
    std::uint32_t from = 0, below = 0, beyond = 0, line = 0, axes = 0, taken = 1;
    for (std::uint32_t d = 0; d < 3; ++d) {
      const std::uint32_t lower = block.lower[d][i], upper = block.upper[d][i];
      const std::uint32_t cell = lower >> kQuantumBits, more = (upper >> kQuantumBits) - cell;
      const std::uint32_t two = (more | more >> 1) & 1;
      from |= (lower >> kCoarser & kLastInEntry) << kFieldBits * d;
      below |= (~upper >> kCoarser & kLastInEntry) << kFieldBits * d;
      beyond |= two * (kLastInEntry << kFieldBits * d);
      axes |= two << d | (more & 2) << 2;
      line += d == 0 ? cell : cell * factors[d];
      taken *= more + 1;
    }
    coded.from[i] = from, coded.below[i] = below, coded.beyond[i] = beyond;
    coded.lines[i] = line, coded.axes[i] = axes;
    cells += i < count ? taken : 0;
  }
  coded.cells = cells;
  for (std::size_t i = 0; i < count; ++i) {
    coded.entries[i] = entry_of(coded.from[i], coded.below[i] & ~coded.beyond[i], bodies[i]);
  }
}

}  // namespace

std::array<std::uint32_t, 3> line_factors(unsigned bits) noexcept {
  return {1, kLineFactors[bits - kMinLineBits][0], kLineFactors[bits - kMinLineBits][1]};
}

void SweptGrid::reset(std::size_t lines, const Executor& executor) {
  const auto nearest = static_cast<std::size_t>(std::max(1.0, 0.7 * static_cast<double>(lines)));
  const unsigned bits = std::clamp(static_cast<unsigned>(std::bit_width(nearest)), kMinLineBits, kMaxLineBits);
  mask_ = (1u << bits) - 1;
  part_shift_ = bits - static_cast<unsigned>(std::bit_width(kParts - 1));
  factors_ = line_factors(bits);
  corner_lines_ = by_corner([&](std::uint32_t d) { return factors_[d]; });
  for (Overflow& more : overflow_) more.lines.clear(), more.free = 0;
  const std::size_t wanted = std::size_t{1} << bits;
  if (lines_.capacity() > 4 * wanted) give_back(lines_);
  if (lines_.size() != wanted) {
    lines_.clear();  // old lines need not move
    lines_.resize(wanted);
  }
  // All lines are written in order, because lines that have left the cache are loaded faster this way than one by one
  // later.
  constexpr std::size_t kMinToShare = std::size_t{1} << 14;  // lines that are worth waking other threads for
  if (wanted < kMinToShare) return std::fill(lines_.begin(), lines_.end(), kEmptyLine);
  const std::size_t size = wanted / kParts;
  auto empty = [&](std::size_t part) {
    std::fill_n(lines_.begin() + static_cast<std::ptrdiff_t>(part * size), size, kEmptyLine);
  };
  run_jobs(executor, kParts, empty);
}

void SweptGrid::release() {
  give_back(lines_);
  for (Overflow& more : overflow_) give_back(more.lines);
}

std::size_t SweptGrid::memory_bytes() const noexcept {
  std::size_t bytes = bytes_of(lines_);
  for (const Overflow& more : overflow_) bytes += bytes_of(more.lines);
  return bytes;
}

void SweptGrid::encode(std::span<const BodyIndex> bodies, const BoxBlock& block, Visits& visits) const {
  Coded coded;
  const std::size_t count = std::min(bodies.size(), kBlock);
  per_machine([&]() ORCHARD_INLINE_LAMBDA { code(coded, block, bodies, factors_); });
  Visit* visit = visits.append(coded.cells);
  for (std::size_t i = 0; i < count; ++i) *visit++ = {coded.entries[i], coded.lines[i] & mask_, 0};
  const auto add = [&](std::size_t i, std::uint32_t corner) {
    const std::uint32_t fields = kFieldsOf[corner];
    const std::uint32_t from = coded.from[i] & ~fields, below = coded.below[i] & (~coded.beyond[i] | fields);
    *visit++ = {entry_of(from, below, bodies[i]), (coded.lines[i] + corner_lines_[corner]) & mask_,
                static_cast<Steps>(kStepsOf[corner])};
  };
  // Which boxes take more than one cell cannot be predicted, so no branch depends on it. Most of these take two cells.
  std::array<std::uint32_t, kBlock> more;
  std::size_t mores = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    more[mores] = i;
    mores += coded.axes[i] != 0;
  }
  for (const std::uint32_t i : std::span(more).first(mores)) {
    const std::uint32_t axes = coded.axes[i];
    if (axes >= 8) {
      visit = visit_rest(bodies[i], block.get(i), visit);
      continue;
    }
    add(i, axes);
    for (std::uint32_t corner = (axes - 1) & axes; corner != 0; corner = (corner - 1) & axes) add(i, corner);
  }
}

// Writes the visits of all cells of a box but the first one. Returns their end.
SweptGrid::Visit* SweptGrid::visit_rest(BodyIndex body, const QuantizedAabb& box, Visit* visit) const noexcept {
  for_each_cell(box, [&](const Cell& cell, std::uint32_t line) {
    std::uint32_t from = 0, below = 0, steps = 0;
    for (std::uint32_t d = 0; d < 3; ++d) {
      const std::uint32_t begin = cell[d] << kQuantumBits, end = begin + (kQuanta - 1);
      from |= (box.lower[d] > begin ? (box.lower[d] - begin) >> kCoarser : 0) << kFieldBits * d;
      below |= (box.upper[d] < end ? (end - box.upper[d]) >> kCoarser : 0) << kFieldBits * d;
      steps |= (cell[d] - (box.lower[d] >> kQuantumBits)) << 2 * d;
    }
    if (steps != 0) *visit++ = {entry_of(from, below, body), line, static_cast<Steps>(steps)};
  });
  return visit;
}

void SweptGrid::split(const Visits& visits, VisitsByPart& parts) const {
  const std::span<const Visit> all = visits.visits();
  std::array<Visit*, kParts> ends;  // a copy, because what is written might be the vectors
  std::array<std::size_t, kParts> counts{};
  for (const Visit& visit : all) ++counts[part_of(visit.line)];
  for (std::size_t i = 0; i < kParts; ++i) ends[i] = parts[i].append(counts[i]);
  for (const Visit& visit : all) *ends[part_of(visit.line)]++ = visit;
}

// The state of insert(). Pairs are collected on the stack and appended to the vector many at a time.
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
    pairs.insert(pairs.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    counts.pairs += count;
    count = 0;
  }
};

// Collects the pairs of the visit's body with those entries of `hits` whose boxes meet its box, if this cell has the
// lower corner of the intersection. No branch depends on the boxes, because in dense worlds none could be predicted.
void SweptGrid::report(Insertion& insertion, const CellLine& line, std::uint64_t hits, const Visit& visit) {
  const BodyIndex body = body_of(visit.entry);
  const BoxInCell box(insertion.boxes[body], visit.steps);
  if (insertion.count + kLineRoom > Insertion::kFound) insertion.hand_over();
  std::size_t count = insertion.count;
  for (; hits != 0; hits &= hits - 1) {
    const BodyIndex other = body_of(line.entries[static_cast<std::size_t>(std::countr_zero(hits))]);
    insertion.found[count] = {std::min(body, other), std::max(body, other)};
    count += box.meets_here(insertion.boxes[other]);
  }
  insertion.count = count;
}

// Inserts a visit whose line is full into the lines that this overflows to.
ORCHARD_INLINE void SweptGrid::insert_beyond(Insertion& insertion, const Visit& visit) {
  Overflow& overflow = overflow_[part_of(visit.line)];
  CellLine* line = &lines_[visit.line];
  while (line->overflow != 0) {
    line = &overflow.lines[line->overflow - 1];
    const std::uint64_t met = meeting(*line, query_from(visit.entry));
    if (met != 0) report(insertion, *line, met, visit);
    ++insertion.counts.lines_read;
  }
  if (line->count == kLineRoom) line = &add_line(*line, overflow);
  line->entries[line->count++] = visit.entry;
}

// First puts all entries into their lines, without branches. Visits that meet other entries there, or find their line
// full, are dealt with afterwards. Entries do not move meanwhile.
void SweptGrid::insert(std::span<const Visit> visits, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
                       GridCounts& counts) {
  constexpr std::size_t kAtOnce = 512, kAhead = 32;
  constexpr unsigned kHitsAt = 16;                  // the first bit of the hits, above the visit's number
  std::array<std::uint32_t, kAtOnce + 1> meetings;  // one more, because what does not count is written, too
  std::array<std::uint16_t, kAtOnce + 1> full;
  Insertion insertion(boxes, pairs, counts);
  counts.entries += visits.size();
  counts.lines_read += visits.size();
  CellLine* const lines = lines_.data();  // a copy, because what is written might be the vector
  for (const Visit& visit : visits.first(std::min(visits.size(), kAhead))) prefetch(&lines[visit.line]);
  for (; !visits.empty(); visits = visits.subspan(std::min(visits.size(), kAtOnce))) {
    const std::size_t count = std::min(visits.size(), kAtOnce);
    std::uint32_t* meets = meetings.data();
    std::uint16_t* fulls = full.data();
    per_machine([&]() ORCHARD_INLINE_LAMBDA {
      const Visit* const all = visits.data();
      const std::size_t last = count, size = visits.size();
      std::uint32_t* meets_end = meets;
      std::uint16_t* fulls_end = fulls;
      for (std::size_t k = 0; k < last; ++k) {
        if (k + kAhead < size) prefetch(&lines[all[k + kAhead].line]);
        CellLine& line = lines[all[k].line];
        const std::uint64_t entry = all[k].entry, met = meeting(line, query_from(entry));
        *meets_end = static_cast<std::uint32_t>(k | met << kHitsAt);
        meets_end += met != 0;
        *fulls_end = static_cast<std::uint16_t>(k);
        fulls_end += put(line, entry);
      }
      meets = meets_end, fulls = fulls_end;
    });
    for (const std::uint32_t meeting : std::span(meetings.data(), meets)) {
      const Visit& visit = visits[meeting & ((1u << kHitsAt) - 1)];
      report(insertion, lines[visit.line], meeting >> kHitsAt, visit);
    }
    if (fulls == full.data()) continue;
    per_machine([&]() ORCHARD_INLINE_LAMBDA {
      for (const std::uint16_t k : std::span(full.data(), fulls)) insert_beyond(insertion, visits[k]);
    });
  }
  insertion.hand_over();
}

// Appends the lines of a box, prefetches them, and returns the end of the list. Whether a body takes one or two cells
// along an axis cannot be predicted, so there are no branches for it: what does not count is written, too.
ORCHARD_INLINE SweptGrid::Removal* SweptGrid::list_removals(BodyIndex body, const QuantizedAabb& box,
                                                            Removal* end) const noexcept {
  std::uint32_t axes = 0, more = 0, first = 0;
  for (std::uint32_t d = 0; d < 3; ++d) {
    const std::uint32_t cell = box.lower[d] >> kQuantumBits, beyond = (box.upper[d] >> kQuantumBits) - cell;
    axes |= (beyond & 1) << d;
    more |= beyond >> 1;
    first += cell * factors_[d];
  }
  const auto add = [&](std::uint32_t line, bool counts) ORCHARD_INLINE_LAMBDA {
    *end = {body, line};
    prefetch(&lines_[line]);
    end += counts ? 1 : 0;
  };
  if (more != 0) {
    for_each_cell(box, [&](const Cell&, std::uint32_t line) ORCHARD_INLINE_LAMBDA { add(line, true); });
    return end;
  }
  const std::uint32_t corners = axes < 4 ? 4 : 8;
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    add((first + corner_lines_[corner]) & mask_, (corner & ~axes) == 0);
  }
  return end;
}

// Appends an overflow line to a chain, after its last line, and returns it.
CellLine& SweptGrid::add_line(CellLine& last, Overflow& overflow) {
  std::vector<CellLine>& lines = overflow.lines;
  std::uint32_t added = overflow.free;
  if (added != 0) {
    overflow.free = lines[added - 1].overflow;
    last.overflow = added;
  } else {
    const bool inner = !lines.empty() && &lines.front() <= &last && &last <= &lines.back();
    const std::size_t index = inner ? static_cast<std::size_t>(&last - lines.data()) : 0;
    grow(lines, lines.size() + 1);
    added = static_cast<std::uint32_t>(lines.size());
    (inner ? lines[index] : last).overflow = added;
  }
  return lines[added - 1] = kEmptyLine;
}

// Removes the entry of a body from a chain of lines. The last entry of the chain takes its place.
ORCHARD_INLINE void SweptGrid::remove_from(CellLine& first, BodyIndex body, Overflow& overflow) noexcept {
  CellLine *line = &first, *before_last = nullptr;
  std::uint64_t* found = nullptr;
  for (;; line = &overflow.lines[line->overflow - 1]) {
    if (found == nullptr) {  // no branch depends on the place of the entry
      const std::uint64_t bits = 1u << line->count | those_of(*line, body);
      const auto index = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (index < line->count) found = &line->entries[index];
    }
    if (line->overflow == 0) break;
    before_last = line;
  }
  assert(found != nullptr);
  if (found == nullptr) return;
  *found = line->entries[--line->count];
  line->entries[line->count] = kGuards;
  if (before_last == nullptr || line->count > 0) return;
  const std::uint32_t freed = std::exchange(before_last->overflow, 0);
  overflow.lines[freed - 1].overflow = overflow.free;
  overflow.free = freed;
}

void SweptGrid::remove(std::span<const BodyIndex> bodies, std::span<const PackedAabb> boxes) noexcept {
  constexpr std::size_t kMostLines =
      std::size_t{kMaxCellsPerAxis} * kMaxCellsPerAxis * kMaxCellsPerAxis;  // at most, of a body
  std::array<Removal, kRemovedAtOnce * kMostLines + 1> removals;
  Removal* end = removals.data();
  for (const BodyIndex body : bodies) end = list_removals(body, boxes[body].whole(), end);
  per_machine([&]() ORCHARD_INLINE_LAMBDA {
    for (const Removal* removal = removals.data(); removal != end; ++removal) {
      remove_from(lines_[removal->line], removal->body, overflow_[part_of(removal->line)]);
    }
  });
}

}  // namespace orchard::runtime::detail
