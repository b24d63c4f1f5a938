#include "arrangement.h"

#include <cmath>
#include <numbers>

#include "orchard/geometry/random.h"

namespace orchard::construction_methods {
namespace {

// Points of an ellipse in order.
PlanarShape random_polygon(Random& random, const PlanePoint& center, double size) {
  const int corners = 3 + static_cast<int>(random.below(5));
  const double turn = random.uniform(0, 2 * std::numbers::pi), flat = random.uniform(0.4, 1);
  std::vector<PlanePoint> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + (i + random.uniform(0, 0.6)) * 2 * std::numbers::pi / corners;
    points.push_back(center + size * PlanePoint(std::cos(angle), flat * std::sin(angle)));
  }
  return PlanarShape::polygon(points);
}

}  // namespace

std::vector<PlanarShape> random_arrangement(std::uint64_t seed) {
  Random random(seed, 1);
  std::vector<PlanarShape> shapes;
  const auto count = 3 + random.below(26);
  for (std::uint64_t i = 0; i < count; ++i) {
    const PlanePoint center(random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1));
    const double size = random.uniform(0.1, 0.7);
    const auto kind = random.below(3);
    if (kind == 0) shapes.push_back(PlanarShape::disk(center, size));
    if (kind == 1)
      shapes.push_back(
          PlanarShape::rectangle(center - PlanePoint(size, size / 2), center + PlanePoint(size, size / 2)));
    if (kind == 2) shapes.push_back(random_polygon(random, center, size));
  }
  return shapes;
}

std::vector<PlanarShape> many_disks(std::size_t count, std::uint64_t seed) {
  Random random(seed, 2);
  const auto n = static_cast<double>(count);
  // About n^2 a e^(-n a) gaps are left by n disks of area a (Hall, Theory of Coverage Processes, 1988).
  double area = 2 / n;
  while (n * n * area * std::exp(-n * area) > 0.7) area *= 1.01;
  const double radius = std::sqrt(area / std::numbers::pi);
  std::vector<PlanarShape> shapes;
  const double edge = 1 + 2 * radius;
  const auto disks = static_cast<std::size_t>(std::ceil(n * edge * edge));
  for (std::size_t i = 0; i < disks; ++i)
    shapes.push_back(
        PlanarShape::disk({random.uniform(-radius, 1 + radius), random.uniform(-radius, 1 + radius)}, radius));
  return shapes;
}

}  // namespace orchard::construction_methods
