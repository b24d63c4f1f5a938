#include <bit>
#include <cassert>

#include "swept_grid.h"

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

// No two cells of a box share a line.
constexpr bool sets_apart(unsigned bits, const std::array<std::uint32_t, 2>& factors) {
  constexpr auto kMaxOffset = static_cast<int>(kMaxCellsPerAxis) - 1;
  const std::uint32_t mask = (1u << bits) - 1;
  for (int z = 0; z <= kMaxOffset; ++z) {
    for (int y = -kMaxOffset; y <= kMaxOffset; ++y) {
      for (int x = -kMaxOffset; x <= kMaxOffset; ++x) {
        const std::uint32_t line = static_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(y) * factors[0] +
                                   static_cast<std::uint32_t>(z) * factors[1];
        if ((x != 0 || y != 0 || z != 0) && (line & mask) == 0) return false;
      }
    }
  }
  return true;
}

constexpr bool all_set_apart() {
  for (unsigned i = 0; i < kLineFactors.size(); ++i) {
    if (!sets_apart(kMinLineBits + i, kLineFactors[i])) return false;
  }
  return true;
}
static_assert(all_set_apart());

}  // namespace

std::array<std::uint32_t, 3> line_factors(unsigned bits) noexcept {
  return {1, kLineFactors[bits - kMinLineBits][0], kLineFactors[bits - kMinLineBits][1]};
}

void SweptGrid::reset(std::size_t lines) {
  const auto nearest = static_cast<std::size_t>(std::max(1.0, 0.7 * static_cast<double>(lines)));
  const unsigned bits = std::clamp(static_cast<unsigned>(std::bit_width(nearest)), kMinLineBits, kMaxLineBits);
  mask_ = (1u << bits) - 1;
  factors_ = line_factors(bits);
  overflow_.clear();
  free_overflow_ = 0;
  // All lines are written in order: those that have not been used for long come faster this way than one by one later.
  const std::size_t wanted = std::size_t{1} << bits;
  if (lines_.capacity() > 4 * wanted) give_back(lines_);
  lines_.assign(wanted, CellLine{});
}

void SweptGrid::release() {
  give_back(lines_);
  give_back(overflow_);
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
      grow(overflow_, overflow_.size() + 1);
      more = static_cast<std::uint32_t>(overflow_.size());
      (inner ? overflow_[index] : first).overflow = more;
      line = &overflow_.back();
    }
  }
  line->entries[line->count++] = entry;
}

void SweptGrid::prepare_removal(const QuantumBox& box) const noexcept {
  prefetch(
      &lines_[line_of({box.lower[0] >> kQuantumBits, box.lower[1] >> kQuantumBits, box.lower[2] >> kQuantumBits})]);
}

void SweptGrid::remove(BodyIndex body, const QuantumBox& box) noexcept {
  Cell cell;
  for (cell[2] = box.lower[2] >> kQuantumBits; cell[2] <= box.upper[2] >> kQuantumBits; ++cell[2]) {
    for (cell[1] = box.lower[1] >> kQuantumBits; cell[1] <= box.upper[1] >> kQuantumBits; ++cell[1]) {
      for (cell[0] = box.lower[0] >> kQuantumBits; cell[0] <= box.upper[0] >> kQuantumBits; ++cell[0]) {
        remove_from(lines_[line_of(cell)], body);
      }
    }
  }
}

// The last entry of the chain takes the place.
void SweptGrid::remove_from(CellLine& first, BodyIndex body) noexcept {
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
