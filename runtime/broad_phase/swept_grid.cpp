#include "broad_phase/swept_grid.h"

#include <bit>
#include <cassert>
#include <cstring>

#include "simd/machine.h"

namespace orchard::runtime::detail {
namespace {

// For tables of 2^6 lines, 2^7 and so on: what the second and the third coordinate of a cell are multiplied by; the
// first one is added as it is. Found by trying at random such that cells that share a line lie far apart: about as far
// as is possible in space, and in each plane of two axes from 2^10 lines on, but nowhere less than four cells along
// some axis, so that the cells of one body never share a line.
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

// A box clipped to a cell, in three fields each: how far it begins from the cell's lower end, and ends from its upper
// end. As a query these change places: two boxes meet if of each axis one's way to its begin and the other's from its
// end make less than a cell together.
constexpr std::uint32_t kEntryBits = 5, kFieldBits = kEntryBits + 1;
constexpr std::uint32_t kCoarser = kQuantumBits - kEntryBits;  // bits of a quantum that are left out of entries
constexpr std::uint32_t kLastInEntry = (1u << kEntryBits) - 1;
static_assert(kIdShift == 6 * kFieldBits);
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

ORCHARD_INLINE std::uint64_t entry_of(std::uint64_t from, std::uint64_t below, BodyIndex body) noexcept {
  return std::uint64_t{body} << kIdShift | below << 3 * kFieldBits | from;
}
ORCHARD_INLINE std::uint64_t query_from(std::uint64_t entry) noexcept {
  constexpr std::uint64_t field = (std::uint64_t{1} << 3 * kFieldBits) - 1;
  return (entry & field) << 3 * kFieldBits | (entry >> 3 * kFieldBits & field);
}
constexpr BodyIndex body_of(std::uint64_t entry) noexcept { return static_cast<BodyIndex>(entry >> kIdShift); }

// Which of a line's entries meet the query, one bit for each: no field of their sum reaches its guard bit, and places
// without an entry are nothing but guard bits.
ORCHARD_INLINE std::uint64_t meeting(const CellLine& line, std::uint64_t query) noexcept {
  std::uint64_t bits = 0;
#ifdef ORCHARD_VECTORS
  using Words __attribute__((vector_size(32))) = std::uint64_t;
  const auto met = [&](std::size_t at, const Words& as) ORCHARD_INLINE_LAMBDA {
    Words half;
    std::memcpy(&half, reinterpret_cast<const char*>(&line) + at, sizeof half);
    return (((half + query) & kGuards) - 1) & (as << kIdShift);  // bits above the guards are set where none of these is
  };
  const Words all = met(0, Words{1, 2, 4, 8}) | met(32, Words{16, 32, 64, 0});
  bits = ((all[0] | all[1]) | (all[2] | all[3])) >> kIdShift;
#else
  for (std::uint32_t i = 0; i < 7; ++i) bits |= std::uint64_t{((query + line.entries[i]) & kGuards) == 0} << i;
#endif
  return bits;
}

// Quanta along the three axes. They are below 2^31, so that two of them are compared at once.
struct Quanta {
  std::uint64_t xy, z;

  static constexpr std::uint64_t kTop = 0x8000000080000000u;
  // The top bits are set where it is at most the other one.
  ORCHARD_INLINE Quanta at_most(const Quanta& other) const noexcept {
    return {(other.xy | kTop) - xy, (other.z | kTop) - z};
  }
  ORCHARD_INLINE static Quanta lower(const PackedAabb& box) noexcept {
    return {box.lower[0] | std::uint64_t{box.lower[1]} << 32, box.lower[2]};
  }
  ORCHARD_INLINE static Quanta upper(const PackedAabb& box) noexcept {
    const Quanta from = lower(box);
    return {from.xy + ((box.lengths & 0xff) | std::uint64_t{box.lengths & 0xff00} << 24), from.z + (box.lengths >> 16)};
  }
};

// A body's box, and one of the cells that it takes: so many steps from its first one along each axis.
class BoxInCell {
 public:
  ORCHARD_INLINE BoxInCell(const PackedAabb& box, std::uint64_t steps) noexcept
      : lower_(Quanta::lower(box)), upper_(Quanta::upper(box)) {
    constexpr std::uint64_t within = kQuanta - 1;  // a cell
    first_ = {
        (lower_.xy & ~(within | within << 32)) + ((steps & 3) << kQuantumBits | (steps & 12) << (30 + kQuantumBits)),
        (lower_.z & ~within) + (steps >> 4 << kQuantumBits)};
    last_ = {first_.xy | within | within << 32, first_.z | within};
    begins_ = first_.at_most(lower_);
  }
  // Whether the other box meets it, and the lower corner of what they have in common lies in the cell.
  ORCHARD_INLINE bool meets_here(const PackedAabb& other) const noexcept {
    const Quanta from = Quanta::lower(other);
    const Quanta after = first_.at_most(from), before = from.at_most(last_), below = from.at_most(upper_),
                 above = lower_.at_most(Quanta::upper(other));
    return (~((after.xy | begins_.xy) & before.xy & below.xy & above.xy) & Quanta::kTop) == 0 &&
           (~((after.z | begins_.z) & before.z & below.z & above.z) & Quanta::kTop) == 0;
  }

 private:
  Quanta lower_, upper_, first_, last_;
  Quanta begins_;  // along which axes it begins in the cell
};

// The neighbours of a cell that lie further along some axes, a bit each: which fields of what lies before the begin of
// a box that goes on to one of them are 0 there, and the steps to there.
template <typename Of>
constexpr std::array<std::uint32_t, 8> by_corner(const Of& of) noexcept {
  std::array<std::uint32_t, 8> all{};
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    for (std::uint32_t d = 0; d < 3; ++d) all[corner] += (corner >> d & 1) * of(d);
  }
  return all;
}
constexpr auto kFieldsOf = by_corner([](std::uint32_t d) { return kLastInEntry << kFieldBits * d; });
constexpr auto kStepsOf = by_corner([](std::uint32_t d) { return 1u << 2 * d; });

// Where bodies' boxes lie in their first cells.
struct Coded {
  using Numbers = std::array<std::uint32_t, kBlock>;
  Numbers from, below;  // in fields, as of a box that takes one cell
  Numbers beyond;       // the fields of the axes along which the box takes the next cell, too
  Numbers lines;        // those with the same last bits are one
  Numbers axes;         // these axes, a bit each, and one above for more than two cells along any
  std::uint32_t cells;  // that all take together
};

// A loop without branches that depend on the data.
ORCHARD_INLINE void code(Coded& coded, const BoxBlock& block, std::size_t count,
                         const std::array<std::uint32_t, 3>& factors) noexcept {
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
  for (Overflow& more : overflow_) more.lines.clear(), more.free = 0;
  const std::size_t wanted = std::size_t{1} << bits;
  if (lines_.capacity() > 4 * wanted) give_back(lines_);
  if (lines_.size() != wanted) {
    lines_.clear();  // what is there need not move
    lines_.resize(wanted);
  }
  // All lines are written in order: those that have not been used for long come faster this way than one by one later.
  constexpr std::size_t kMinToShare = std::size_t{1} << 14;  // lines that are worth waking other threads for
  const std::size_t size = wanted / kParts;
  auto empty = [&](std::size_t part) {
    std::fill_n(lines_.begin() + static_cast<std::ptrdiff_t>(part * size), size, kEmptyLine);
  };
  run_jobs(wanted < kMinToShare ? Executor{} : executor, kParts, empty);
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
  per_machine([&]() ORCHARD_INLINE_LAMBDA { code(coded, block, count, factors_); });
  Visit* visit = visits.append(coded.cells);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t entry = entry_of(coded.from[i], coded.below[i] & ~coded.beyond[i], bodies[i]);
    *visit++ = {entry, coded.lines[i] & mask_, 0};
  }
  const auto lines_of = by_corner([&](std::uint32_t d) { return factors_[d]; });
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t axes = coded.axes[i];
    if (axes >= 8) {
      visit = visit_rest(bodies[i], block.get(i), visit);
      continue;
    }
    for (std::uint32_t corner = axes; corner != 0; corner = (corner - 1) & axes) {
      const std::uint32_t fields = kFieldsOf[corner];
      const std::uint32_t from = coded.from[i] & ~fields, below = coded.below[i] & (~coded.beyond[i] | fields);
      *visit++ = {entry_of(from, below, bodies[i]), (coded.lines[i] + lines_of[corner]) & mask_,
                  static_cast<Steps>(kStepsOf[corner])};
    }
  }
}

// All cells but the first one.
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
  std::array<Visit*, kParts> ends;  // by themselves: what is written might be the vectors
  std::array<std::size_t, kParts> counts{};
  for (const Visit& visit : all) ++counts[part_of(visit.line)];
  for (std::size_t i = 0; i < kParts; ++i) ends[i] = parts[i].append(counts[i]);
  for (const Visit& visit : all) *ends[part_of(visit.line)]++ = visit;
}

// Of the entries hit, those whose box really meets the body's, and in this cell first.
void SweptGrid::report(const CellLine& line, std::uint64_t hits, const Visit& visit, std::span<const PackedAabb> boxes,
                       std::vector<BodyPair>& pairs) {
  const BodyIndex body = body_of(visit.entry);
  const BoxInCell box(boxes[body], visit.steps);
  for (; hits != 0; hits &= hits - 1) {
    const BodyIndex other = body_of(line.entries[static_cast<std::size_t>(std::countr_zero(hits))]);
    if (box.meets_here(boxes[other])) pairs.push_back({std::min(body, other), std::max(body, other)});
  }
}

// Where the line is full: in those that it overflows to.
ORCHARD_INLINE void SweptGrid::insert_beyond(const Visit& visit, std::span<const PackedAabb> boxes,
                                             std::vector<BodyPair>& pairs, GridCounts& counts) {
  Overflow& overflow = overflow_[part_of(visit.line)];
  CellLine* line = &lines_[visit.line];
  while (line->overflow != 0) {
    line = &overflow.lines[line->overflow - 1];
    const std::uint64_t met = meeting(*line, query_from(visit.entry));
    if (met != 0) report(*line, met, visit, boxes, pairs);
    ++counts.lines_read;
  }
  if (line->count == kLineRoom) line = &add_line(*line, overflow);
  line->entries[line->count++] = visit.entry;
}

void SweptGrid::insert(std::span<const Visit> visits, std::span<const PackedAabb> boxes, std::vector<BodyPair>& pairs,
                       GridCounts& counts) {
  const std::size_t before = pairs.size();
  counts.entries += visits.size();
  counts.lines_read += visits.size();
  per_machine([&]() ORCHARD_INLINE_LAMBDA {
    constexpr std::size_t kAhead = 32;
    CellLine* const lines = lines_.data();
    const Visit* const all = visits.data();
    const std::size_t count = visits.size();
    for (std::size_t k = 0; k < count; ++k) {
      if (k + kAhead < count) prefetch(&lines[all[k + kAhead].line]);
      CellLine& line = lines[all[k].line];
      const std::uint64_t met = meeting(line, query_from(all[k].entry));
      if (met != 0) report(line, met, all[k], boxes, pairs);
      if (line.count < kLineRoom) {
        line.entries[line.count++] = all[k].entry;
      } else {
        insert_beyond(all[k], boxes, pairs, counts);
      }
    }
  });
  counts.pairs += pairs.size() - before;
}

// After the last one of a chain.
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

// The last entry of the chain takes the place.
void SweptGrid::remove_from(CellLine& first, BodyIndex body, Overflow& overflow) noexcept {
  CellLine *line = &first, *before_last = nullptr;
  std::uint64_t* found = nullptr;
  for (;; line = &overflow.lines[line->overflow - 1]) {
    for (std::uint32_t i = 0; found == nullptr && i < line->count; ++i) {
      if (body_of(line->entries[i]) == body) found = &line->entries[i];
    }
    if (line->overflow == 0) break;
    before_last = line;
  }
  assert(found != nullptr);
  if (found == nullptr) return;
  *found = line->entries[--line->count];
  line->entries[line->count] = kGuards;
  if (line->count > 0 || before_last == nullptr) return;
  const std::uint32_t freed = std::exchange(before_last->overflow, 0);
  overflow.lines[freed - 1].overflow = overflow.free;
  overflow.free = freed;
}

void SweptGrid::remove(BodyIndex body, const QuantizedAabb& box) noexcept {
  for_each_cell(box,
                [&](const Cell&, std::uint32_t line) { remove_from(lines_[line], body, overflow_[part_of(line)]); });
}

}  // namespace orchard::runtime::detail
