#include <bit>
#include <cassert>

#include "broad_phase/line_compare.h"

// Making room in the grid, and taking boxes out of it.
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

}  // namespace

std::array<std::uint32_t, 3> line_factors(unsigned bits) noexcept {
  return {1, kLineFactors[bits - kMinLineBits][0], kLineFactors[bits - kMinLineBits][1]};
}

void SweptGrid::begin_reset(std::size_t lines) {
  in_order_ = false;
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
}

// All lines are written in order: those that have not been used for long come faster this way than one by one later.
void SweptGrid::empty_part(std::size_t part) noexcept {
  if (in_order_) return;
  const std::size_t size = lines_.size() / kParts;
  std::fill_n(lines_.begin() + static_cast<std::ptrdiff_t>(part * size), size, kEmptyLine);
}

void SweptGrid::empty_parts(const Executor& executor) {
  constexpr std::size_t kMinToShare = std::size_t{1} << 14;  // lines that are worth waking other threads for
  if (in_order_) return;
  if (lines_.size() < kMinToShare) {
    std::fill(lines_.begin(), lines_.end(), kEmptyLine);
  } else {
    auto empty = [&](std::size_t part) { empty_part(part); };
    run_jobs(executor, kParts, empty);
  }
  in_order_ = true;
}

void SweptGrid::release() {
  in_order_ = true;
  give_back(lines_);
  for (Overflow& more : overflow_) give_back(more.lines);
}

std::size_t SweptGrid::memory_bytes() const noexcept {
  std::size_t bytes = bytes_of(lines_);
  for (const Overflow& more : overflow_) bytes += bytes_of(more.lines);
  return bytes;
}

void SweptGrid::append(CellLine& first, std::uint64_t entry, Overflow& overflow) {
  std::vector<CellLine>& lines = overflow.lines;
  CellLine* line = &first;
  while (line->overflow != 0) line = &lines[line->overflow - 1];
  if (line->count == line->entries.size()) {
    std::uint32_t more = overflow.free;
    if (more != 0) {
      overflow.free = lines[more - 1].overflow;
      lines[more - 1] = kEmptyLine;
      line->overflow = more;
      line = &lines[more - 1];
    } else {
      const bool inner = line != &first;
      const std::size_t index = inner ? static_cast<std::size_t>(line - lines.data()) : 0;
      grow(lines, lines.size() + 1);
      more = static_cast<std::uint32_t>(lines.size());
      (inner ? lines[index] : first).overflow = more;
      line = &lines.back();
      *line = kEmptyLine;
    }
  }
  line->entries[line->count++] = entry;
}

// Without branches where a body takes two cells along an axis at most: which do cannot be predicted.
void SweptGrid::prepare_removal(BodyIndex body, const QuantizedAabb& box, Removals& removals) const noexcept {
  Cell first, more;  // cells, and how many beyond
  for (std::size_t d = 0; d < 3; ++d) {
    first[d] = box.lower[d] >> kQuantumBits;
    more[d] = (box.upper[d] >> kQuantumBits) - first[d];
  }
  const std::uint32_t line = line_of(first);
  const auto add = [&](std::uint32_t at, bool counts) {
    removals.all_[removals.count_] = {body, (line + at) & mask_};
    prefetch(&lines_[(line + at) & mask_]);
    removals.count_ += counts;
  };
  if ((more[0] | more[1] | more[2]) < 2) {
    const std::uint32_t taken = more[0] | more[1] << 1 | more[2] << 2;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      std::uint32_t at = 0;
      for (std::uint32_t d = 0; d < 3; ++d) at += (corner >> d & 1) * factors_[d];
      add(at, (corner & ~taken) == 0);
      if (corner == 3 && more[2] == 0) return;
    }
    return;
  }
  for (std::uint32_t z = 0; z <= more[2]; ++z) {
    for (std::uint32_t y = 0; y <= more[1]; ++y) {
      for (std::uint32_t x = 0; x <= more[0]; ++x) add(x * factors_[0] + y * factors_[1] + z * factors_[2], true);
    }
  }
}

// The last entry of the chain takes the place.
template <typename Kind>
ORCHARD_INLINE void SweptGrid::remove_from(CellLine& first, BodyIndex body, Overflow& overflow) noexcept {
  CellLine *line = &first, *found = nullptr, *before_last = nullptr;
  std::uint32_t index = 0;
  for (;;) {
    if (found == nullptr) {  // without branches that depend on where it is
      const std::uint32_t none = line->count, bits = 1u << none | static_cast<std::uint32_t>(Kind::of(*line, body));
      index = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (index < none) found = line;
    }
    if (line->overflow == 0) break;
    before_last = line;
    line = &overflow.lines[line->overflow - 1];
  }
  assert(found != nullptr);
  if (found == nullptr) return;
  found->entries[index] = line->entries[--line->count];
  line->entries[line->count] = kGuards;
  if (line->count == 0 && before_last != nullptr) free_last(*before_last, overflow);
}

template <typename Kind>
ORCHARD_INLINE void SweptGrid::remove_all(std::span<const Removal> removals) noexcept {
  for (const Removal& removal : removals) {
    remove_from<Kind>(lines_[removal.line], removal.body, overflow_[part_of(removal.line)]);
  }
}

void SweptGrid::remove(Removals& removals) noexcept {
  const auto all = std::span(std::as_const(removals.all_)).first(removals.count_);
  removals.count_ = 0;
  with_best_compare([&]<typename Kind>() ORCHARD_INLINE_LAMBDA { remove_all<Kind>(all); });
}

void SweptGrid::free_last(CellLine& before, Overflow& overflow) noexcept {
  const std::uint32_t freed = before.overflow;
  before.overflow = 0;
  overflow.lines[freed - 1].overflow = overflow.free;
  overflow.free = freed;
}

}  // namespace orchard::runtime::detail
