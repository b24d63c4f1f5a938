#include "hard_sets.h"

#include <cmath>
#include <numbers>

#include "orchard/geometry/random.h"

namespace orchard::bench {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Point in_cube(Random& random) { return {random.uniform(), random.uniform(), random.uniform()}; }

// Of a normal distribution in each coordinate (Box and Muller).
Vector gaussian(Random& random) {
  Vector v;
  for (int axis = 0; axis < 3; ++axis)
    v[axis] = std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(kTurn * random.uniform());
  return v;
}

}  // namespace

test::Points cluster_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 8);
  std::array<Point, 5> centers;
  for (Point& center : centers) center = 4 * in_cube(random);
  test::Points points(n);
  for (std::size_t i = 0; i < n; ++i)
    points[i] = centers[i % 5] + std::pow(0.1, static_cast<double>(i % 5)) * gaussian(random);
  return points;
}

test::Points cylinder_ring_points(int rings, int around) {
  test::Points points;
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < around; ++i) {
      const double angle = kTurn * i / around;
      points.emplace_back(2 * std::cos(angle), 2 * std::sin(angle), 10.0 * ring / (rings - 1));
    }
  return points;
}

test::Points torus_lattice_points(int around, int across) {
  test::Points points;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = kTurn * i / around, v = kTurn * j / across, r = 1 + 0.35 * std::cos(v);
      points.emplace_back(r * std::cos(u), r * std::sin(u), 0.35 * std::sin(v));
    }
  return points;
}

test::Points integer_grid_points(int k) {
  test::Points points;
  for (int x = 0; x < k; ++x)
    for (int y = 0; y < k; ++y)
      for (int z = 0; z < k; ++z) points.emplace_back(x, y, z);
  return points;
}

test::Points noisy_line_points(std::size_t n, std::uint64_t seed) {
  constexpr std::size_t kLines = 10;
  Random random(seed, 9);
  test::Points points;
  for (std::size_t line = 0; line < kLines; ++line) {
    const Point from = in_cube(random), to = in_cube(random);
    for (std::size_t i = 0; i < n / kLines; ++i)
      points.push_back(from + random.uniform() * (to - from) + 1e-5 * gaussian(random));
  }
  return points;
}

test::Points moment_curve_points(std::size_t n) {
  test::Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(n);
    points.emplace_back(t, t * t, t * t * t);
  }
  return points;
}

test::Points skew_line_points(std::size_t n, std::uint64_t seed) {
  Random random(seed, 10);
  test::Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = random.uniform();
    points.push_back(i % 2 == 0 ? Point(t, 0, 0) : Point(0.5, t - 0.5, 1));
  }
  return points;
}

}  // namespace orchard::bench
