#include "collision/support_box.h"

#include <limits>

#include "collision/support_map.h"

namespace orchard::runtime::detail {

SupportBox support_box(const TreeView& tree) noexcept {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(), kCoordinateRounding = 1e-14;  // of coordinates
  SupportBox box{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  if (tree.supports.empty()) return box;
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3 up{}, down{};
    up[i] = 1, down[i] = -1;
    const double high = reach_along(tree.supports, up), low = -reach_along(tree.supports, down);
    const double margin =
        tree.vertex_error + kCoordinateRounding * (std::fabs(high) + std::fabs(low) + std::fabs(tree.origin[i]));
    box.low[i] = tree.origin[i] + low - margin;
    box.high[i] = tree.origin[i] + high + margin;
  }
  return box;
}

}  // namespace orchard::runtime::detail
