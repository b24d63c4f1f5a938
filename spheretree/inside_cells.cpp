#include "inside_cells.h"

#include <algorithm>
#include <cmath>

namespace orchard::detail {
namespace {

constexpr double kRoom = 1 + 1e-9;  // over the half diagonal, for points that a rounding puts into the next cell

}  // namespace

InsideCells::InsideCells(const Surface& surface, int depth)
    : surface_(surface), per_axis_(1 << depth), cell_(surface.bounding_box().sizes() / per_axis_) {
  side_.resize(index(0, 0, per_axis_));
  fill({0, 0, 0}, per_axis_);
}

// A cube of cells, by the distance of its centre if that is enough, else by its eight parts.
void InsideCells::fill(const std::array<int, 3>& first, int cells) {
  const Vector corner(first[0], first[1], first[2]);
  const Vector middle = corner + Vector::Constant(0.5 * cells);
  const double distance = surface_.signed_distance(surface_.bounding_box().min() + middle.cwiseProduct(cell_));
  const bool known = std::abs(distance) > kRoom * 0.5 * cells * cell_.norm();
  if (!known && cells > 1) {
    for (int part = 0; part < 8; ++part)
      fill({first[0] + (part & 1) * cells / 2, first[1] + (part >> 1 & 1) * cells / 2,
            first[2] + (part >> 2) * cells / 2},
           cells / 2);
    return;
  }
  const Side side = !known ? Side::both : distance < 0 ? Side::inside : Side::outside;
  for (int z = first[2]; z < first[2] + cells; ++z)
    for (int y = first[1]; y < first[1] + cells; ++y)
      std::fill_n(side_.begin() + static_cast<std::ptrdiff_t>(index(first[0], y, z)), cells, side);
}

bool InsideCells::inside(const Point& point) const {
  const Box& box = surface_.bounding_box();
  if (!box.contains(point)) return false;
  std::array<int, 3> at{};
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = cell_[axis] > 0 ? (point[axis] - box.min()[axis]) / cell_[axis] : 0;
    at[static_cast<std::size_t>(axis)] = std::min(static_cast<int>(cells), per_axis_ - 1);
  }
  const Side side = side_[index(at[0], at[1], at[2])];
  return side == Side::both ? surface_.inside(point) : side == Side::inside;
}

}  // namespace orchard::detail
