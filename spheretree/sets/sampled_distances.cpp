#include "sampled_distances.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "infinity.h"
#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

constexpr double kGoldenAngle = 2.39996322972865332;  // radians
// As a share of the largest radius: a point that is less deep in another ball counts as on the boundary, because of
// rounding.
constexpr double kOnBoundary = 1e-12;
constexpr Index kLeastSamples = 32;          // the minimum for a ball, even if it is small compared with the others
constexpr Index kCuroboSphereSamples = 200;  // the number on each ball in cuRobo's measure
constexpr double kCuroboPercentile = 0.95;
constexpr std::uint64_t kSampleStage = 6500;  // the stream of random numbers

// Returns random points of a surface, stratified by area.
std::vector<Point> surface_points(const Surface& surface, Index count, std::uint64_t seed) {
  const std::size_t triangles = surface.mesh().triangles.size();
  std::vector<double> until(triangles);
  double area = 0;
  for (Index t = 0; t < triangles; ++t) until[t] = area += surface.area(t);
  std::vector<Point> points(count);
  for (Index i = 0; i < count; ++i) {
    Random random(seed, kSampleStage, i);
    const double at = area * (i + random.uniform()) / count;
    const auto found = std::min(std::upper_bound(until.begin(), until.end(), at), until.end() - 1);
    const auto [a, b, c] = surface.corners(static_cast<Index>(found - until.begin()));
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    points[i] = a + u * (b - a) + v * (c - a);
  }
  return points;
}

double mean(const std::vector<double>& values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Interpolates between the two values around the quantile, as common libraries of arrays do.
double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace

Vector on_sphere(Index i, Index n) {
  const double z = 1 - (2.0 * i + 1) / n, turn = kGoldenAngle * i, across = std::sqrt(std::max(0.0, 1 - z * z));
  return {across * std::cos(turn), across * std::sin(turn), z};
}

UnionBoundary::UnionBoundary(std::span<const Sphere> balls, Index count)
    : balls_(balls), slack_(0), neighbors_(balls.size()), nearest_({}) {
  double squares = 0;
  for (const Sphere& ball : balls) {
    squares += ball.radius * ball.radius;
    slack_ = std::max(slack_, kOnBoundary * ball.radius);
  }
  find_neighbors();
  std::vector<std::vector<Sample>> of_ball(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t b) {
    const Sphere& ball = balls[b];
    const Index n = std::max(kLeastSamples, static_cast<Index>(count * ball.radius * ball.radius / squares));
    const double area = 4 * std::numbers::pi * ball.radius * ball.radius / n;
    for (Index i = 0; i < n; ++i) {
      const Point at = ball.center + ball.radius * on_sphere(i, n);
      if (is_free(at, static_cast<Index>(b))) of_ball[b].push_back({at, static_cast<Index>(b), area});
    }
  });
  std::vector<Point> points;
  for (const std::vector<Sample>& own : of_ball)
    for (const Sample& sample : own) {
      samples_.push_back(sample);
      points.push_back(sample.at);
      area_ += sample.area;
    }
  nearest_ = NearestSample(std::move(points));
}

void UnionBoundary::find_neighbors() {
  tbb::parallel_for(std::size_t{0}, balls_.size(), [&](std::size_t b) {
    for (Index other = 0; other < balls_.size(); ++other) {
      const double reach = balls_[b].radius + balls_[other].radius;
      if (other != b && (balls_[b].center - balls_[other].center).squaredNorm() < reach * reach)
        neighbors_[b].push_back(other);
    }
  });
}

bool UnionBoundary::is_free(const Point& point, Index ball, Index other) const {
  for (Index n : neighbors_[ball]) {
    if (n == other) continue;
    const double room = balls_[n].radius - slack_;
    if (room > 0 && (point - balls_[n].center).squaredNorm() < room * room) {
      // If two balls are equal, the boundary belongs to the first one.
      const bool same = balls_[n].center == balls_[ball].center && balls_[n].radius == balls_[ball].radius;
      if (!same || n < ball) return false;
    }
  }
  return true;
}

double UnionBoundary::depth(const Point& point) const {
  double best = kInfinity;
  // The distance from the nearest point of a single sphere bounds the result, so that few samples have to be compared.
  for (Index b = 0; b < balls_.size(); ++b) {
    const Vector away = point - balls_[b].center;
    const double length = away.norm(), distance = std::abs(balls_[b].radius - length);
    if (!(length > 0) || distance >= best) continue;
    if (is_free(balls_[b].center + balls_[b].radius / length * away, b)) best = distance;
  }
  nearest_.visit(point, best, [&](Index i) {
    const Sample& sample = samples_[i];
    best = std::min(best, (sample.at - point).norm());
    const Sphere& ball = balls_[sample.ball];
    const Vector away = point - ball.center;
    const double length = away.norm();
    if (length > 0 && std::abs(ball.radius - length) < best) {
      const Point projected = ball.center + ball.radius / length * away;
      if (is_free(projected, sample.ball))
        best = std::abs(ball.radius - length);
      else
        best = through_circles(point, sample.ball, best);
    }
    return best;
  });
  return best;
}

// Returns the distance to the nearest points of the circles in which the ball's sphere meets its neighbours.
double UnionBoundary::through_circles(const Point& point, Index ball, double least) const {
  const Sphere& own = balls_[ball];
  for (Index n : neighbors_[ball]) {
    const Vector between = balls_[n].center - own.center;
    const double distance = between.norm();
    if (!(distance > 0)) continue;
    const Vector axis = between / distance;
    const double along =
        (distance * distance + own.radius * own.radius - balls_[n].radius * balls_[n].radius) / (2 * distance);
    const double squared = own.radius * own.radius - along * along;
    if (!(squared > 0)) continue;
    const Point middle = own.center + along * axis;
    Vector out = point - middle;
    out -= out.dot(axis) * axis;
    if (!(out.norm() > 0)) continue;
    const Point nearest = middle + std::sqrt(squared) * out.normalized();
    if ((nearest - point).norm() < least && is_free(nearest, ball, n)) least = (nearest - point).norm();
  }
  return least;
}

SurfaceGaps surface_gaps(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options) {
  SurfaceGaps result{surface_points(surface, options.surface_samples, options.seed), {}};
  result.gaps.resize(result.points.size());
  tbb::parallel_for(std::size_t{0}, result.points.size(),
                    [&](std::size_t i) { result.gaps[i] = std::max(0.0, gap_from(balls, result.points[i])); });
  return result;
}

MeanDistances mean_distances(const Surface& surface, std::span<const Sphere> balls, const SurfaceGaps& from,
                             const SphereAuditOptions& options) {
  const UnionBoundary boundary(balls, options.sphere_samples);
  std::vector<double> to_union = from.gaps;
  tbb::parallel_for(std::size_t{0}, to_union.size(), [&](std::size_t i) {
    if (from.gaps[i] == 0) to_union[i] = boundary.depth(from.points[i]);
  });
  const auto samples = boundary.samples();
  std::vector<double> distances(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(),
                    [&](std::size_t i) { distances[i] = surface.signed_distance(samples[i].at); });
  MeanDistances result;
  result.gap = mean(from.gaps);
  result.surface_to_union = mean(to_union);
  result.boundary_area = boundary.area();
  double outside = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    result.union_to_surface += samples[i].area * std::abs(distances[i]);
    if (distances[i] > 0) outside += samples[i].area, result.protrusion += samples[i].area * distances[i];
  }
  if (boundary.area() > 0) {
    result.union_to_surface /= boundary.area();
    result.protrusion /= boundary.area();
    result.outside_share = outside / boundary.area();
  }
  return result;
}

CuroboFigures curobo_figures(const Surface& surface, std::span<const Sphere> balls, const UnionVolume& volume,
                             const SurfaceGaps& from) {
  CuroboFigures figures;
  figures.num_spheres = static_cast<Index>(balls.size());
  figures.coverage = volume.solid > 0 ? 1 - volume.uncovered.value / volume.solid : 0;
  std::vector<double> distances(balls.size() * kCuroboSphereSamples);
  tbb::parallel_for(std::size_t{0}, distances.size(), [&](std::size_t i) {
    const Sphere& ball = balls[i / kCuroboSphereSamples];
    const auto k = static_cast<Index>(i % kCuroboSphereSamples);
    distances[i] = surface.signed_distance(ball.center + ball.radius * on_sphere(k, kCuroboSphereSamples));
  });
  const double all = static_cast<double>(distances.size());
  std::erase_if(distances, [](double distance) { return !(distance > 0); });
  figures.protrusion = static_cast<double>(distances.size()) / all;
  figures.protrusion_dist_mean = mean(distances);
  figures.protrusion_dist_p95 = quantile(distances, kCuroboPercentile);
  figures.surface_gap_mean = mean(from.gaps);
  figures.surface_gap_p95 = quantile(from.gaps, kCuroboPercentile);
  figures.max_uncovered_gap = from.gaps.empty() ? 0 : *std::max_element(from.gaps.begin(), from.gaps.end());
  double sum = 0;
  for (const Sphere& ball : balls) sum += 4 * std::numbers::pi / 3 * ball.radius * ball.radius * ball.radius;
  figures.volume_ratio = volume.solid > 0 ? sum / volume.solid : 0;
  return figures;
}

}  // namespace orchard::detail
