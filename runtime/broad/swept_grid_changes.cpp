#include <bit>
#include <cassert>

#include "swept_grid.h"

// Making room in the grid, and taking boxes out of it.
namespace orchard::runtime::detail {

void SweptGrid::reset(std::size_t lines) {
  constexpr int kFewestBits = 2;  // kMostCellsPerAxis cells
  const auto nearest = static_cast<std::size_t>(std::max(1.0, 0.7 * static_cast<double>(lines)));
  const int bits = std::max(3 * kFewestBits, static_cast<int>(std::bit_width(nearest)));
  const int x = (bits + 2) / 3, y = (bits + 1) / 3, z = bits / 3;
  mask_ = {(1u << x) - 1, (1u << y) - 1, (1u << z) - 1};
  shift_ = {0, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(x + y)};
  overflow_.clear();
  free_overflow_ = 0;
  // All lines are written in order: those that have not been used for long come faster this way than one by one later.
  const std::size_t wanted = std::size_t{1} << bits;
  if (lines_.capacity() > wanted) lines_ = {};
  lines_.assign(wanted, CellLine{});
}

void SweptGrid::release() {
  lines_ = {};
  overflow_ = {};
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
