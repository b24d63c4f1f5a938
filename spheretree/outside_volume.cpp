#include "orchard/spheretree/outside_volume.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "inside_cells.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// Powers of 1 / 1.2207.., the root of x^4 = x + 1: the three-dimensional golden ratio (Roberts 2018).
constexpr double kStepX = 0.8191725133961645, kStepY = 0.6710436067037893, kStepZ = 0.5497004779019703;

// Cells for telling inside from outside: about as many distances to make them as they save one by one.
int depth_for(std::uint64_t points) { return points < 100'000 ? 4 : 5; }

double fraction(double x) { return x - std::floor(x); }

}  // namespace

double outside_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t points) {
  if (!surface.solid()) throw InputError("the outside volume needs a closed surface; repair the mesh first");
  if (balls.empty() || points == 0) return 0;
  Box box;
  for (const Sphere& ball : balls) {
    box.extend(Point(ball.center - Vector::Constant(ball.radius)));
    box.extend(Point(ball.center + Vector::Constant(ball.radius)));
  }
  // Balls that reach a slab of the box, so that a point looks at few of them.
  constexpr std::size_t kSlabs = 64;
  std::vector<std::vector<Sphere>> slabs(kSlabs);
  const double width = box.sizes().x() / kSlabs;
  const auto slab_of = [&](double x) {
    return static_cast<std::size_t>(std::clamp((x - box.min().x()) / width, 0.0, kSlabs - 1.0));
  };
  for (const Sphere& ball : balls)
    for (std::size_t s = slab_of(ball.center.x() - ball.radius); s <= slab_of(ball.center.x() + ball.radius); ++s)
      slabs[s].push_back(ball);
  const detail::InsideCells cells(surface, depth_for(points));
  const auto counts = [&](std::uint64_t i) {
    const double n = static_cast<double>(i);
    const Vector unit(fraction(0.5 + n * kStepX), fraction(0.5 + n * kStepY), fraction(0.5 + n * kStepZ));
    const Point p = box.min() + unit.cwiseProduct(box.sizes());
    const auto& near = slabs[slab_of(p.x())];
    return std::any_of(
               near.begin(), near.end(),
               [&](const Sphere& ball) { return (p - ball.center).squaredNorm() <= ball.radius * ball.radius; }) &&
           !cells.inside(p);
  };
  const std::uint64_t outside = tbb::parallel_reduce(
      tbb::blocked_range<std::uint64_t>(0, points), std::uint64_t{0},
      [&](const auto& range, std::uint64_t sum) {
        for (std::uint64_t i = range.begin(); i != range.end(); ++i) sum += counts(i);
        return sum;
      },
      std::plus<>());
  return box.volume() * static_cast<double>(outside) / static_cast<double>(points);
}

}  // namespace orchard
