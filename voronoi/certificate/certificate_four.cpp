#include "certificate/certificate_four.h"

#include <limits>

#include "predicates/vectors.h"
#include "workspace/workspace_four.h"

namespace orchard::detail {

#ifdef ORCHARD_FOUR_LANES

namespace {

ORCHARD_AVX2 void load_spheres(const std::array<const VoronoiVertex*, 4>& v, FourVectors& center,
                               __m256d& squared_radius) {
  center = {_mm256_load_pd(v[0]->center.data()), _mm256_load_pd(v[1]->center.data()),
            _mm256_load_pd(v[2]->center.data())};
  squared_radius = _mm256_load_pd(v[3]->center.data());  // the radius is behind it
  transpose(center.x, center.y, center.z, squared_radius);
}
// The same as Certifier::near_power(), for four vertices.
ORCHARD_AVX2 __m256d near_powers(const FourVectors& q, const FourVectors& center, const FourVectors& corner) {
  const FourVectors from_corner = q - corner, to_center = center - corner;
  const FourVectors rest{all_four(2) * to_center.x - from_corner.x, all_four(2) * to_center.y - from_corner.y,
                         all_four(2) * to_center.z - from_corner.z};
  return dot(from_corner, rest);
}

// The same as Certifier::apart_by(), for four vertices.
ORCHARD_AVX2 __m256d apart_by(__m256d off, __m256d radius, double diameter) {
  const __m256d times = _mm256_min_pd(all_four(diameter) / (all_four(0.75) * radius), all_four(2));
  const __m256d is_near = _mm256_cmp_pd(off, radius / all_four(8), _CMP_LE_OQ);
  return _mm256_blendv_pd(all_four(diameter), off * (all_four(4) * times), is_near);
}

ORCHARD_AVX2 FourVectors load_own_spheres(const Workspace& workspace, const std::array<Index, 4>& v,
                                          __m256d& squared_radius) {
  const VoronoiVertex* const vertices = workspace.vertices.data();
  FourVectors center{};
  load_spheres({vertices + v[0], vertices + v[1], vertices + v[2], vertices + v[3]}, center, squared_radius);
  return center;
}

}  // namespace

[[gnu::target("avx2")]] unsigned doubtful_of_four(const Workspace& workspace, const Facet* facets) {
  const auto& [a, b, c, d] = *reinterpret_cast<const std::array<Facet, 4>*>(facets);
  const std::array<Index, 4> v{a.v, b.v, c.v, d.v}, u{a.u, b.u, c.u, d.u};
  const Point* const points = workspace.points.data();
  const FourVectors opposite =
      load_four({points + a.opposite, points + b.opposite, points + c.opposite, points + d.opposite});
  return ~workspace.agree_four(u, v, opposite) & 0xf;
}

[[gnu::target("avx2")]] std::array<double, 4> added_by_four(const FourSteps& steps, double diameter) {
  const FourVectors a = load_four(steps.a), ab = load_four(steps.b) - a, ac = load_four(steps.c) - a;
  FourVectors normal = cross(ab, ac);
  const __m256d size = length(normal), blur = all_four(8 * kRounding) * length(ab) * length(ac) / size;
  normal = {normal.x / size, normal.y / size, normal.z / size};
  FourVectors from{}, to{};
  __m256d from_squared{}, to_squared{};
  load_spheres(steps.from, from, from_squared);
  load_spheres(steps.to, to, to_squared);
  const FourVectors step = to - from;
  const __m256d zero = _mm256_setzero_pd(), two = all_four(2), far = all_four(diameter);
  const __m256d radius = _mm256_sqrt_pd(from_squared), reach = _mm256_min_pd(far, two * radius);
  const __m256d along = dot(normal, step);
  const FourVectors aside{step.x - along * normal.x, step.y - along * normal.y, step.z - along * normal.z};
  const __m256d sideways = length(aside) + (two * blur + all_four(8 * kRounding)) * length(step);
  const __m256d lost = near_powers(a, from, load_four(steps.from_corner)) -
                       near_powers(a, to, load_four(steps.to_corner)) +
                       all_four(16 * kRounding) * (radius + _mm256_sqrt_pd(to_squared) + far) * far;
  const __m256d added = (_mm256_max_pd(zero, lost) + two * reach * (_mm256_max_pd(zero, -along) + sideways)) / radius;
  std::array<double, 4> result;
  _mm256_storeu_pd(result.data(), _mm256_blendv_pd(all_four(std::numeric_limits<double>::infinity()), added,
                                                   _mm256_cmp_pd(blur, all_four(kBlurred), _CMP_LT_OQ)));
  return result;
}

[[gnu::target("avx2")]] void told_of_four(const Workspace& workspace, const std::array<Index, 4>& v, double far,
                                          double* radius, double* apart) {
  const Workspace::FourSpheres spheres = workspace.spheres(v);
  _mm256_storeu_pd(radius, spheres.radius);
  const __m256d told = _mm256_blendv_pd(spheres.power_bound / spheres.radius, all_four(far), spheres.shared);
  _mm256_storeu_pd(apart, workspace.exact() ? _mm256_setzero_pd() : told);
}

[[gnu::target("avx2")]] FourSeen apart_of_four(const Workspace& workspace, const std::array<Index, 4>& v,
                                               const FourOffCenters& off, double diameter) {
  __m256d squared_radius{};
  const FourVectors center = load_own_spheres(workspace, v, squared_radius);
  const __m256d off_center = _mm256_loadu_pd(off.off.data()), radius = _mm256_sqrt_pd(squared_radius);
  FourSeen seen;
  _mm256_storeu_pd(seen.apart.data(), apart_by(off_center, radius, diameter));
  _mm256_storeu_pd(seen.power_bound.data(), Workspace::own_power_bounds(center, squared_radius, radius, off_center));
  return seen;
}

[[gnu::target("avx2")]] FourMoved moved_four(const Workspace& workspace, const std::array<Index, 4>& v,
                                             const FourOffCenters& off, double diameter) {
  __m256d squared_radius{};
  const FourVectors from = load_own_spheres(workspace, v, squared_radius);
  const FourVectors step{_mm256_loadu_pd(off.x.data()), _mm256_loadu_pd(off.y.data()), _mm256_loadu_pd(off.z.data())};
  const FourVectors center = from - step;
  std::array<const Point*, 4> corners;
  for (unsigned i = 0; i < 4; ++i) corners[i] = &workspace.points[workspace.vertices[v[i]].forming_points[0]];
  squared_radius = squared(center - load_four(corners));
  const __m256d sum = absolute(center.x) + absolute(center.y) + absolute(center.z);
  const __m256d rest = _mm256_loadu_pd(off.rest.data()) + all_four(2 * kRounding) * sum;
  const __m256d radius = _mm256_sqrt_pd(squared_radius);
  FourMoved moved;
  _mm256_storeu_pd(moved.apart.data(), apart_by(rest, radius, diameter));
  _mm256_storeu_pd(moved.power_bound.data(), Workspace::own_power_bounds(center, squared_radius, radius, rest));
  _mm256_storeu_pd(moved.x.data(), center.x);
  _mm256_storeu_pd(moved.y.data(), center.y);
  _mm256_storeu_pd(moved.z.data(), center.z);
  _mm256_storeu_pd(moved.squared_radius.data(), squared_radius);
  return moved;
}

#else

unsigned doubtful_of_four(const Workspace&, const Facet*) { return 0xf; }
std::array<double, 4> added_by_four(const FourSteps&, double) { return {}; }
void told_of_four(const Workspace&, const std::array<Index, 4>&, double, double*, double*) {}
FourSeen apart_of_four(const Workspace&, const std::array<Index, 4>&, const FourOffCenters&, double) { return {}; }
FourMoved moved_four(const Workspace&, const std::array<Index, 4>&, const FourOffCenters&, double) { return {}; }

#endif

}  // namespace orchard::detail
