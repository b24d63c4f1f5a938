#pragma once
#include <algorithm>
#include <atomic>
#include <vector>

#include "workspace/workspace.h"

namespace orchard::detail {

// Records which points form vertices. Several threads may record at once. There are no branches: the number of the
// point at infinity, which free vertices have instead of points, too, wraps around to the first element.
class FormingPoints {
 public:
  explicit FormingPoints(std::size_t points) : forms_(points + 1, 0) {}
  void note(const VoronoiVertex& vertex) {
    static_assert(static_cast<Index>(kInfinitePoint + 1) == 0 && kNone == kInfinitePoint);
    for (const Index point : vertex.forming_points)
      std::atomic_ref(forms_[static_cast<Index>(point + 1)]).store(1, std::memory_order_relaxed);
  }
  bool has(Index point) const { return forms_[point + 1] != 0; }
  std::size_t count() const { return static_cast<std::size_t>(std::count(forms_.begin() + 1, forms_.end(), 1)); }

 private:
  std::vector<std::uint8_t> forms_;  // by point
};

}  // namespace orchard::detail
