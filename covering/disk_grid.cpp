#include "disk_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace orchard::detail {
namespace {

constexpr double kDisksPerCell = 4;
constexpr double kMostAlong = 64;  // cells
// The margin around the box, relative to its coordinates: far more than rounding can move a region's sides.
constexpr double kRoom = 1e-9;

}  // namespace

DiskGrid::Rectangle DiskGrid::around(const Disk& disk) {
  const double x = disk.center.x(), y = disk.center.y(), r = disk.radius;
  return {x - r, x + r, y - r, y + r};
}

void DiskGrid::lay_out(const Eigen::AlignedBox2d& box, std::size_t count) {
  const double room = kRoom * (box.min().norm() + box.max().norm());
  box_ = {box.min().x() - room, box.max().x() + room, box.min().y() - room, box.max().y() + room};
  const double width = box_.right - box_.left, height = box_.top - box_.bottom;
  const double side = std::max(std::sqrt(width * height * kDisksPerCell / static_cast<double>(count)),
                               std::max(width, height) / kMostAlong);
  columns_ = side > 0 ? static_cast<std::size_t>(width / side) + 1 : 1;
  rows_ = side > 0 ? static_cast<std::size_t>(height / side) + 1 : 1;
  columns_per_length_ = width > 0 ? static_cast<double>(columns_) / width : 0;
  rows_per_length_ = height > 0 ? static_cast<double>(rows_) / height : 0;
}

// The cells that the rectangle's part in the box meets. Coordinates map to cells monotonically, so two rectangles that
// meet in the box share a cell.
DiskGrid::Cells DiskGrid::cells_of(const Rectangle& rectangle) const {
  const auto at = [](double offset, double per_length, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(offset * per_length, 0.0, static_cast<double>(count) - 1));
  };
  return {at(rectangle.left - box_.left, columns_per_length_, columns_),
          at(rectangle.right - box_.left, columns_per_length_, columns_),
          at(rectangle.bottom - box_.bottom, rows_per_length_, rows_),
          at(rectangle.top - box_.bottom, rows_per_length_, rows_)};
}

void DiskGrid::build(std::span<const Disk> disks, const Eigen::AlignedBox2d& box) {
  lay_out(box, std::max<std::size_t>(1, disks.size()));
  const std::size_t cell_count = columns_ * rows_;
  rectangles_.resize(disks.size());
  cells_.resize(disks.size());
  marks_.assign((disks.size() + 63) / 64, 0);
  begin_.assign(cell_count + 1, 0);
  const auto for_each_listed = [&](auto&& visit) {
    for (Index i = 0; i < disks.size(); ++i) {
      if (disks[i].radius <= 0 || !rectangles_[i].meets(box_) || is_everywhere(cells_[i])) continue;
      for (std::size_t row = cells_[i].bottom; row <= cells_[i].top; ++row)
        for (std::size_t cell = row * columns_ + cells_[i].left; cell <= row * columns_ + cells_[i].right; ++cell)
          visit(i, cell);
    }
  };
  for (Index i = 0; i < disks.size(); ++i) {
    if (disks[i].radius <= 0) continue;
    rectangles_[i] = around(disks[i]);
    cells_[i] = cells_of(rectangles_[i]);
    if (rectangles_[i].meets(box_) && is_everywhere(cells_[i])) mark(i);
  }
  everywhere_ = marks_;
  for_each_listed([&](Index, std::size_t cell) { ++begin_[cell]; });
  Index sum = 0;
  for (Index& begin : begin_) begin = sum += begin;  // ends, from which filling counts down
  in_cell_.resize(sum);
  for_each_listed([&](Index disk, std::size_t cell) { in_cell_[--begin_[cell]] = disk; });
}

void DiskGrid::meeting(const Disk& disk, std::vector<Index>& out) {
  out.clear();
  Rectangle asked = around(disk);
  if (!asked.meets(box_)) return;
  asked = {std::max(asked.left, box_.left), std::min(asked.right, box_.right), std::max(asked.bottom, box_.bottom),
           std::min(asked.top, box_.top)};
  marks_ = everywhere_;
  const Cells cells = cells_of(asked);
  for (std::size_t row = cells.bottom; row <= cells.top; ++row) {
    const Index end = begin_[row * columns_ + cells.right + 1];
    for (Index k = begin_[row * columns_ + cells.left]; k < end; ++k) mark(in_cell_[k]);
  }
  for (std::size_t word = 0; word < marks_.size(); ++word)
    for (std::uint64_t bits = marks_[word]; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<Index>(64 * word + static_cast<std::size_t>(std::countr_zero(bits)));
      if (rectangles_[i].meets(asked)) out.push_back(i);
    }
}

}  // namespace orchard::detail
