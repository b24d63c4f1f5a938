#include "swept_grid.h"

#include <bit>
#include <cassert>
#include <cmath>

#include "../vector_support.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kMiddle = 1073741824.0;     // the origin's quantum, 2^30
constexpr double kFarQuanta = 1073741824.0;  // beyond, a box is everything: rounding is no longer under control
constexpr double kRoundingQuanta = 0x1p-8;   // covers some roundings of numbers below 2^31
constexpr std::uint32_t kFieldBits = kQuantumBits + 1;
constexpr std::uint64_t kGuards = 0x820820820u;  // bit 5 of each of six fields
constexpr std::uint32_t kIdShift = 6 * kFieldBits;
static_assert(kMaxBodies < (1u << (64 - kIdShift)));

// A clipped box as an entry or as a query: entry's field <= query's field in all six means that they meet.
struct Code {
  std::uint64_t entry, query;
};

ORCHARD_INLINE Code code_of(const QuantumBox& box, const std::array<std::uint32_t, 3>& cell) noexcept {
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
    const Words entries = load<Words>(line);  // the eighth is the counters
    const Words hit =
        reinterpret_cast<Words>(((spread<Words>(query) - entries) & spread<Words>(kGuards)) == spread<Words>(kGuards));
    const Words bits = hit & Words{1, 2, 4, 8, 16, 32, 64, 0};
    const auto parts = std::bit_cast<std::array<Half, 2>>(bits);
    const Half sum = parts[0] | parts[1];
    return static_cast<std::uint32_t>((sum[0] | sum[1]) | (sum[2] | sum[3]));
  }
};
#endif

}  // namespace

Lattice::Lattice(const Vec3& origin, double cell_size) noexcept : origin_(origin), per_length_(kQuanta / cell_size) {
  double size = 0;
  for (const double x : origin) size = std::max(size, std::fabs(x));
  margin_ = kRoundingQuanta + 8 * kMotionSlack * (size * per_length_ + kFarQuanta);
}

// The centre's offset along an axis is at most v t + spread(t), which is convex: largest at an end. Likewise below.
ORCHARD_INLINE void Lattice::make_boxes(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept {
  std::array<double, kBlock> spread, radius, far;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double t = motions.duration[i];
    spread[i] = t * (motions.drift[i] + t * motions.acceleration[i] / 2) * per_length_;
    radius[i] = motions.radius[i] * per_length_ + margin_;
    far[i] = std::max(spread[i], radius[i]);
  }
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t i = 0; i < lanes; ++i) {
      const double begin = (motions.position[d][i] - origin_[d]) * per_length_;
      const double way = motions.velocity[d][i] * motions.duration[i] * per_length_;
      far[i] = std::max(far[i], std::max(std::fabs(begin), std::fabs(way)));
      const double lower = kMiddle + (begin + std::min(0.0, way - spread[i]) - radius[i]);
      const double upper = kMiddle + (begin + std::max(0.0, way + spread[i]) + radius[i]);
      const auto quantum = [](double q) ORCHARD_INLINE_LAMBDA {
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::min(std::max(q, 0.0), double{kLastQuantum})));
      };
      boxes.lower[d][i] = quantum(lower);
      boxes.upper[d][i] = quantum(upper);
    }
  }
  for (std::size_t i = 0; i < lanes; ++i) {
    if (far[i] < kFarQuanta) [[likely]]
      continue;
    for (std::size_t d = 0; d < 3; ++d) boxes.lower[d][i] = 0, boxes.upper[d][i] = kLastQuantum;
  }
}

void Lattice::boxes_plain(const MotionBlock& motions, std::size_t lanes, BoxBlock& boxes) const noexcept {
  make_boxes(motions, lanes, boxes);
}
ORCHARD_PER_MACHINE void Lattice::boxes_vectors(const MotionBlock& motions, std::size_t lanes,
                                                BoxBlock& boxes) const noexcept {
  make_boxes(motions, lanes, boxes);
}

void Lattice::boxes(const MotionBlock& motions, std::size_t count, BoxBlock& boxes, bool vectors) const noexcept {
  vectors ? boxes_vectors(motions, lanes_for(count), boxes) : boxes_plain(motions, lanes_for(count), boxes);
}

void SweptGrid::reset(std::size_t lines) {
  constexpr int kFewestBits = 2;  // kMostCellsPerAxis cells
  const int bits = std::max(3 * kFewestBits, static_cast<int>(std::bit_width(std::max<std::size_t>(lines, 1) - 1)));
  const int x = (bits + 2) / 3, y = (bits + 1) / 3, z = bits / 3;
  mask_ = {(1u << x) - 1, (1u << y) - 1, (1u << z) - 1};
  shift_ = {0, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(x + y)};
  lines_.assign(std::size_t{1} << bits, CellLine{});
  overflow_.clear();
  free_overflow_ = 0;
}

ORCHARD_INLINE std::size_t SweptGrid::line_of(const std::array<std::uint32_t, 3>& cell) const noexcept {
  return (std::size_t{cell[0] & mask_[0]} << shift_[0]) | (std::size_t{cell[1] & mask_[1]} << shift_[1]) |
         (std::size_t{cell[2] & mask_[2]} << shift_[2]);
}

void SweptGrid::append(CellLine& first, std::uint64_t entry) {
  CellLine* line = &first;
  while (line->overflow != 0) line = &overflow_[line->overflow - 1];
  if (line->count == line->entries.size()) {
    std::uint32_t more = free_overflow_;
    if (more != 0) {
      free_overflow_ = overflow_[more - 1].overflow;
      overflow_[more - 1] = CellLine{};
      line->overflow = more;
      line = &overflow_[more - 1];
    } else {
      const bool inner = line != &first;
      const std::size_t index = inner ? static_cast<std::size_t>(line - overflow_.data()) : 0;
      overflow_.emplace_back();
      more = static_cast<std::uint32_t>(overflow_.size());
      (inner ? overflow_[index] : first).overflow = more;
      line = &overflow_.back();
    }
  }
  line->entries[line->count++] = entry;
}

struct SweptGrid::Insertion {
  std::span<const BodyId> bodies;
  const BoxBlock& block;
  std::span<const QuantumBox> boxes;
  std::vector<BodyPair>& pairs;
};

struct SweptGrid::Visit {
  std::size_t line;
  std::uint64_t entry, query;
  Cell cell;
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

template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_in_line(const Insertion& insertion, CellLine& first, std::uint64_t entry,
                                              std::uint64_t query, const Cell& cell) {
  const CellLine* line = &first;
  for (;;) {
    ++counts_.lines_read;
    const std::uint32_t hits = Kind::meeting(*line, query) & ((1u << line->count) - 1);
    if (hits != 0) report(insertion, *line, hits, static_cast<BodyId>(entry >> kIdShift), cell);
    if (line->overflow == 0) [[likely]]
      break;
    line = &overflow_[line->overflow - 1];
  }
  ++counts_.entries;
  if (first.count < first.entries.size()) [[likely]] {
    first.entries[first.count++] = entry;
  } else {
    append(first, entry);
  }
}

// First every body in the cell of its lower corner, then the few that take several cells in the others: a loop without
// branches that depend on the data, and the rest.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::insert_all(const Insertion& insertion) {
  const BoxBlock& block = insertion.block;
  const std::size_t count = insertion.bodies.size();
  std::array<std::uint64_t, kBlock> entry, query;
  std::array<std::uint32_t, kBlock> line, several;
  const std::size_t lanes = lanes_for(count);
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
  for (std::size_t i = 0; i < count; ++i) prefetch(&lines_[line[i]]);  // they are all over memory
  std::array<std::uint32_t, kBlock> rest;
  std::size_t rests = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Cell cell = {block.lower[0][i] >> kQuantumBits, block.lower[1][i] >> kQuantumBits,
                       block.lower[2][i] >> kQuantumBits};
    insert_in_line<Kind>(insertion, lines_[line[i]], entry[i] | std::uint64_t{insertion.bodies[i]} << kIdShift,
                         query[i], cell);
    rest[rests] = i;
    rests += several[i] != 0;
  }
  counts_.bodies += count;

  std::array<Visit, kBlock> visits;  // in two rounds as well: load the lines, then use them
  std::size_t waiting = 0;
  const auto flush = [&]() ORCHARD_INLINE_LAMBDA {
    for (std::size_t k = 0; k < waiting; ++k) {
      insert_in_line<Kind>(insertion, lines_[visits[k].line], visits[k].entry, visits[k].query, visits[k].cell);
    }
    waiting = 0;
  };
  for (std::size_t k = 0; k < rests; ++k) {
    const std::uint32_t i = rest[k];
    const QuantumBox box = block.get(i);
    const std::uint64_t id = std::uint64_t{insertion.bodies[i]} << kIdShift;
    Cell cell, first, last;
    for (std::size_t d = 0; d < 3; ++d) first[d] = box.lower[d] >> kQuantumBits, last[d] = box.upper[d] >> kQuantumBits;
    for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
      for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
        for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
          if (cell == first) continue;
          if (waiting == visits.size()) flush();
          const Code code = code_of(box, cell);
          visits[waiting] = {line_of(cell), code.entry | id, code.query, cell};
          prefetch(&lines_[visits[waiting++].line]);
        }
      }
    }
  }
  flush();
}

void SweptGrid::insert_plain(const Insertion& insertion) { insert_all<PlainCompare>(insertion); }

#ifdef ORCHARD_VECTORS
ORCHARD_PER_MACHINE void SweptGrid::insert_vectors(const Insertion& insertion) { insert_all<VectorCompare>(insertion); }
#else
void SweptGrid::insert_vectors(const Insertion& insertion) { insert_all<PlainCompare>(insertion); }
#endif

void SweptGrid::insert(std::span<const BodyId> bodies, const BoxBlock& block, std::span<const QuantumBox> boxes,
                       bool vectors, std::vector<BodyPair>& pairs) {
  const std::size_t before = pairs.size();
  const Insertion insertion{bodies, block, boxes, pairs};
  vectors ? insert_vectors(insertion) : insert_plain(insertion);
  counts_.pairs += pairs.size() - before;
}

void SweptGrid::prepare_removal(const QuantumBox& box) const noexcept {
  prefetch(
      &lines_[line_of({box.lower[0] >> kQuantumBits, box.lower[1] >> kQuantumBits, box.lower[2] >> kQuantumBits})]);
}

void SweptGrid::remove(BodyId body, const QuantumBox& box) noexcept {
  std::array<std::uint32_t, 3> cell;
  for (cell[2] = box.lower[2] >> kQuantumBits; cell[2] <= box.upper[2] >> kQuantumBits; ++cell[2]) {
    for (cell[1] = box.lower[1] >> kQuantumBits; cell[1] <= box.upper[1] >> kQuantumBits; ++cell[1]) {
      for (cell[0] = box.lower[0] >> kQuantumBits; cell[0] <= box.upper[0] >> kQuantumBits; ++cell[0]) {
        remove_from(lines_[line_of(cell)], body);
      }
    }
  }
}

// The last entry of the chain takes the place.
void SweptGrid::remove_from(CellLine& first, BodyId body) noexcept {
  CellLine *line = &first, *found = nullptr, *before_last = nullptr;
  std::uint32_t index = 0;
  for (;;) {
    for (std::uint32_t i = 0; found == nullptr && i < line->count; ++i) {
      if (line->entries[i] >> kIdShift == body) found = line, index = i;
    }
    if (line->overflow == 0) break;
    before_last = line;
    line = &overflow_[line->overflow - 1];
  }
  assert(found != nullptr);
  if (found == nullptr) return;
  found->entries[index] = line->entries[--line->count];
  if (line->count == 0 && before_last != nullptr) free_last(*before_last);
}

void SweptGrid::free_last(CellLine& before) noexcept {
  const std::uint32_t freed = before.overflow;
  before.overflow = 0;
  overflow_[freed - 1].overflow = free_overflow_;
  free_overflow_ = freed;
}

}  // namespace orchard::runtime::detail
