#include "orchard/spheretree/union_volume.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <vector>

#include "golden_steps.h"
#include "orchard/geometry/error.h"
#include "parallel_rays.h"

namespace orchard {
namespace {

using detail::ByRay, detail::Crossing, detail::fraction, detail::Interval, detail::ParallelRays;

constexpr int kSets = 8;  // of rays
// The exact volume is used if the rays' volume agrees with it within so many standard errors or within this part of it.
constexpr double kAgreeingErrors = 6, kAgreeingPart = 2e-3;
// 2^(1/2) - 1 and 3^(1/2) - 1: multiples of these shift the sets along the two axes, and keep them well apart.
constexpr double kShiftX = 0.41421356237309515, kShiftY = 0.7320508075688772;

// The integrals of 1, x and x x^T over a body. All bodies have the same origin.
struct Moments {
  double mass = 0;
  Vector first = Vector::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  Moments& operator+=(const Moments& other) {
    mass += other.mass;
    first += other.first;
    second += other.second;
    return *this;
  }
  void scale(double by) {
    mass *= by;
    first *= by;
    second *= by;
  }
};

MassProperties properties(const Moments& moments, const Point& origin) {
  MassProperties result;
  result.volume = moments.mass;
  if (!(moments.mass > 0)) return result;
  const Vector center = moments.first / moments.mass;
  const Eigen::Matrix3d central = moments.second - moments.mass * center * center.transpose();
  result.center = origin + center;
  result.inertia = central.trace() * Eigen::Matrix3d::Identity() - central;
  return result;
}

Box box_of(std::span<const Sphere> balls) {
  Box box;
  for (const Sphere& ball : balls) {
    box.extend(Point(ball.center - Vector::Constant(ball.radius)));
    box.extend(Point(ball.center + Vector::Constant(ball.radius)));
  }
  return box;
}

void join(std::span<const Interval> chords, std::vector<Interval>& parts) {
  parts.clear();
  for (const Interval& chord : chords) {
    if (!parts.empty() && chord.begin <= parts.back().end)
      parts.back().end = std::max(parts.back().end, chord.end);
    else
      parts.push_back(chord);
  }
}

// The part of a ray where the winding number is above 0.
void find_inside(std::span<const Crossing> crossings, std::vector<Interval>& parts) {
  parts.clear();
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].rise;
    if (winding > 0 && crossings[i].at < crossings[i + 1].at) parts.push_back({crossings[i].at, crossings[i + 1].at});
  }
}

double common_length(std::span<const Interval> a, std::span<const Interval> b) {
  double length = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    length += std::max(0.0, std::min(a[i].end, b[j].end) - std::max(a[i].begin, b[j].begin));
    (a[i].end < b[j].end ? i : j) += 1;
  }
  return length;
}

// The results of one set of rays.
struct SetResult {
  Moments balls, solid;
  double common = 0;
};

void add(std::span<const Interval> parts, const ParallelRays& rays, std::size_t ray, const Point& origin,
         Moments& moments) {
  const auto [x_axis, y_axis, z_axis] = rays.axes();
  Vector at = Vector::Zero();
  at[x_axis] = rays[ray].x() - origin[x_axis];
  at[y_axis] = rays[ray].y() - origin[y_axis];
  for (const Interval& part : parts) {
    const double begin = part.begin - origin[z_axis], end = part.end - origin[z_axis], length = end - begin;
    const double middle = (begin + end) / 2;
    at[z_axis] = middle;
    moments.mass += length;
    moments.first += length * at;
    moments.second += length * at * at.transpose();
    moments.second(z_axis, z_axis) += length * length * length / 12;
  }
}

SetResult measure(const Surface& surface, std::span<const Sphere> balls, const ParallelRays& rays,
                  const Point& origin) {
  ByRay<Crossing> through_surface(rays.size());
  ByRay<Interval> through_balls(rays.size());
  find_crossings(surface, rays, through_surface);
  find_chords(balls, rays, through_balls);
  SetResult result;
  std::vector<Interval> in_balls, in_solid;
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    join(through_balls[ray], in_balls);
    find_inside(through_surface[ray], in_solid);
    add(in_balls, rays, ray, origin, result.balls);
    add(in_solid, rays, ray, origin, result.solid);
    result.common += common_length(in_balls, in_solid);
  }
  const double of_ray = rays.area() / static_cast<double>(rays.size());
  result.balls.scale(of_ray);
  result.solid.scale(of_ray);
  result.common *= of_ray;
  return result;
}

template <class Value>
Estimate estimate(const std::array<SetResult, kSets>& sets, const Value& value) {
  double sum = 0, squared = 0;
  for (const SetResult& set : sets) sum += value(set);
  const double mean = sum / kSets;
  for (const SetResult& set : sets) squared += (value(set) - mean) * (value(set) - mean);
  return {mean, std::sqrt(squared / (kSets * (kSets - 1)))};
}

}  // namespace

UnionVolume union_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t count) {
  if (!surface.solid()) throw InputError("the volume beside a solid needs a closed surface; repair the mesh first");
  Box box = surface.bounding_box();
  box.extend(box_of(balls));
  const Point origin = box.center();
  std::array<SetResult, kSets> sets;
  tbb::parallel_for(0, kSets, [&](int k) {
    const ParallelRays rays(box, std::max<std::uint64_t>(1, count / kSets),
                            {fraction(0.5 + k * kShiftX), fraction(0.5 + k * kShiftY)});
    sets[static_cast<std::size_t>(k)] = measure(surface, balls, rays, origin);
  });
  UnionVolume result;
  result.balls = estimate(sets, [](const SetResult& set) { return set.balls.mass; });
  result.outside = estimate(sets, [](const SetResult& set) { return std::max(0.0, set.balls.mass - set.common); });
  result.uncovered = estimate(sets, [](const SetResult& set) { return std::max(0.0, set.solid.mass - set.common); });
  const Estimate solid = estimate(sets, [](const SetResult& set) { return set.solid.mass; });
  Moments of_balls, of_solid;
  for (SetResult& set : sets) of_balls += set.balls, of_solid += set.solid;
  of_balls.scale(1.0 / kSets);
  of_solid.scale(1.0 / kSets);
  result.of_balls = properties(of_balls, origin);
  result.of_solid = mass_properties(surface);
  const double exact = result.of_solid.volume;
  if (std::abs(solid.value - exact) > std::max(kAgreeingErrors * solid.error, kAgreeingPart * exact))
    result.of_solid = properties(of_solid, origin);
  result.solid = result.of_solid.volume;
  return result;
}

MassProperties mass_properties(const Surface& surface) {
  const Point origin = surface.bounding_box().center();
  Moments moments;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    auto [a, b, c] = surface.corners(t);
    a -= origin, b -= origin, c -= origin;
    // A tetrahedron with its apex in the origin: the integral of x x^T is V / 20 (s s^T + sum of the corners').
    const double volume = a.dot(b.cross(c)) / 6;
    const Vector sum = a + b + c;
    moments.mass += volume;
    moments.first += volume / 4 * sum;
    moments.second += volume / 20 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  return properties(moments, origin);
}

double inertia_difference(const MassProperties& a, const MassProperties& b, bool equal_mass) {
  const double scale = equal_mass && a.volume > 0 ? b.volume / a.volume : 1;
  const double size = b.inertia.norm();
  return size > 0 ? (scale * a.inertia - b.inertia).norm() / size : 0;
}

}  // namespace orchard
