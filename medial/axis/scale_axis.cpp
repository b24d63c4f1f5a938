#include "scale_axis.h"

#include <tbb/parallel_for.h>

#include "ball_tree.h"

namespace orchard::detail {

std::vector<std::uint8_t> covered_when_scaled(std::span<const Point> centers, std::span<const double> radii,
                                              double scale) {
  std::vector<std::uint8_t> covered(centers.size(), 0);
  if (!(scale > 1)) return covered;
  std::vector<Box> boxes;
  for (const Point& center : centers) boxes.emplace_back(center);
  const BallTree tree(std::move(boxes), {radii.begin(), radii.end()});
  tbb::parallel_for(std::size_t{0}, centers.size(), [&](std::size_t i) {
    const double own = -scale * radii[i];
    const auto reach = [&](Index other) {
      if (!(radii[other] > radii[i])) return 0.0;
      return (centers[other] - centers[i]).norm() - scale * radii[other];
    };
    covered[i] = tree.min(centers[i], own, reach, scale) < own ? 1 : 0;
  });
  return covered;
}

}  // namespace orchard::detail
