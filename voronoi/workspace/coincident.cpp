#include "workspace/coincident.h"

#include <bit>
#include <cstdint>

#include "orchard/geometry/grid_cell.h"

namespace orchard::detail {
namespace {

// Widths of cells over the distance, and the factor between two of them.
constexpr double kWide = 1024, kNarrow = 2, kNarrower = 8;
constexpr std::size_t kLongRun = 48;  // slots that are searched for one cell before all cells are made narrower

// A hash grid with linear probing. Its cells are much wider than the distance, so that for most points one cell has to
// be searched. Points of different cells may share a run of slots; comparing these, too, does no harm. Where points
// crowd together, the cells are made narrower: a cell of twice the distance holds only a few points, because these are
// at least the distance apart.
class Grid {
 public:
  Grid(std::span<const Point> points, double distance)
      : points_(points), distance_(distance), width_(distance * kWide), slots_(std::bit_ceil(2 * points.size() + 1)) {
    for (Index& slot : slots_) slot = kNone;
  }

  // Returns the lowest point within the distance, or adds the point and returns kNone.
  Index find_or_add(Index point) {
    const Point& p = points_[point];
    const Vector from_origin = p - points_[0];
    const Vector reach = Vector::Constant(distance_);
    const GridCell low = grid_cell(from_origin - reach, width_), high = grid_cell(from_origin + reach, width_);
    Index found = kNone;
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) found = std::min(found, find({x, y, z}, p));
    if (found == kNone) add(home(from_origin), point);
    if (crowded_) narrow();
    return found;
  }
  void add(Index point) { add(home(points_[point] - points_[0]), point); }

 private:
  GridCell home(const Vector& from_origin) const { return grid_cell(from_origin, width_); }
  Index find(const GridCell& cell, const Point& p) {
    Index found = kNone;
    std::size_t looked_at = 0;
    for (std::size_t slot = hash_of(cell) & mask(); slots_[slot] != kNone; slot = (slot + 1) & mask(), ++looked_at)
      if ((points_[slots_[slot]] - p).squaredNorm() <= distance_ * distance_) found = std::min(found, slots_[slot]);
    if (looked_at > kLongRun && width_ > kNarrow * distance_) crowded_ = true;
    return found;
  }
  void narrow() {
    crowded_ = false;
    width_ = std::max(width_ / kNarrower, kNarrow * distance_);
    std::vector<Index> all(slots_.size(), kNone);
    all.swap(slots_);
    for (const Index point : all)
      if (point != kNone) add(point);
  }
  void add(const GridCell& cell, Index point) {
    std::size_t slot = hash_of(cell) & mask();
    while (slots_[slot] != kNone) slot = (slot + 1) & mask();
    slots_[slot] = point;
  }
  std::size_t mask() const { return slots_.size() - 1; }

  std::span<const Point> points_;
  double distance_, width_;
  bool crowded_ = false;
  std::vector<Index> slots_;
};

}  // namespace

std::vector<std::array<Index, 2>> coincident_points(std::span<const Point> points, double distance) {
  return coincident_points(points, distance, 0, {});
}

std::vector<std::array<Index, 2>> coincident_points(std::span<const Point> points, double distance, Index first_new,
                                                    const std::vector<bool>& present) {
  std::vector<std::array<Index, 2>> pairs;
  if (points.size() < 2) return pairs;
  Grid grid(points, distance);
  for (Index i = 0; i < first_new; ++i)
    if (present[i]) grid.add(i);
  for (Index i = first_new; i < points.size(); ++i) {
    const Index same = grid.find_or_add(i);
    if (same != kNone) pairs.push_back({i, same});
  }
  return pairs;
}

}  // namespace orchard::detail
