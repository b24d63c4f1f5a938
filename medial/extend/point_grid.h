#pragma once
#include <unordered_map>
#include <vector>

#include "orchard/geometry/grid_cell.h"

namespace orchard::detail {

// A grid of numbered points that are added one by one. Its cubes are as wide as the search distance.
class PointGrid {
 public:
  // `reach` > 0, mesh units.
  explicit PointGrid(double reach) : reach_(reach) {}

  void add(const Point& point, Index item) { items_[orchard::hash_of(cell_of(point))].push_back(item); }

  // Calls visit(item) for all items with a point within `reach` of a place, and for some others, so the visitor has to
  // measure. An item with several points may be visited several times.
  template <class Visit>
  void visit_near(const Point& place, const Visit& visit) const {
    const GridCell middle = cell_of(place);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto at = items_.find(orchard::hash_of({middle[0] + x, middle[1] + y, middle[2] + z}));
          if (at == items_.end()) continue;
          for (const Index item : at->second) visit(item);
        }
  }

 private:
  GridCell cell_of(const Point& point) const { return grid_cell(point, reach_); }

  double reach_;
  // The items in each cube; cubes with the same hash share a list.
  std::unordered_map<std::uint64_t, std::vector<Index>> items_;
};

}  // namespace orchard::detail
