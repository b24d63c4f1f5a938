#include <algorithm>
#include <limits>

#include "certificate/certifier.h"
#include "workspace/workspace_four.h"

namespace orchard::detail {
namespace {

// The share of the intrusion by which a vertex's sphere may differ from its own sphere according to the error bound. If
// the bound is larger, its own sphere is computed.
constexpr double kTold = 1.0 / 64;

// If the bound is more than this many times larger, the cheapest test usually cannot show that the sphere is right.
constexpr double kHopelesslyTold = 0x1p11;

}  // namespace

// Also tests whether the sphere of the vertex is nearly its own. If doubles could not place it well, it is placed
// again, and so is a vertex that has a neighbour's sphere and is too far from it.
bool Certifier::is_oriented(Index v) { return workspace_.at_infinity(v) ? is_hull_facet(v) : is_oriented(v, look(v)); }

bool Certifier::is_hull_facet(Index v) {
  found_.hull.push_back(v);
  return is_triangle(corner(v, 0), corner(v, 1), corner(v, 2));
}

Certifier::Look Certifier::look(Index v) {
  Look seen;
  seen.negative = six_volumes(v);
  if (seen.negative.sign() == Sign::positive) return seen;
  workspace_.settle(v);
  seen.apart = from_told_sphere(v);
  const double enough = kTold * max_;
  const bool can_be_seen = seen.negative.sign() == Sign::negative && !workspace_.shares_sphere(v);
  if (can_be_seen && seen.apart > enough && seen.apart <= kHopelesslyTold * enough)
    seen.apart = std::min(seen.apart, from_seen_sphere(v));
  if (can_be_seen && seen.apart > enough) seen.apart = std::min(seen.apart, from_moved_sphere(v));
  if (seen.apart > enough) seen.has_center = own_center(v, seen.center);
  return seen;
}

bool Certifier::is_oriented(Index v, const Look& seen) {
  const Determinant& det = seen.negative;
  if (det.sign() == Sign::positive ||
      (det.sign() == Sign::uncertain &&
       volume_sign(corner(v, 3), corner(v, 0), corner(v, 1), corner(v, 2)) != Sign::negative))
    return false;
  note_volume(v, det.value);
  double apart = seen.apart;
  if (apart > kTold * max_) {
    if (!seen.has_center) return false;
    const Vector& center = seen.center;
    const bool shared = workspace_.shares_sphere(v);
    apart = from_sphere(v, center);
    if (apart > (shared ? kGiven : kTold) * max_) {
      workspace_.place_sharply(v, center);
      apart = 0;
    } else if (!shared) {
      workspace_.note_own_center(v, (corner(v, 0) + center - workspace_.vertices[v].center).norm());
    }
  }
  if (apart > small_share_ && workspace_.shares_sphere(v)) found_.lossy.push_back(v);
  found_.given = std::max(found_.given, apart);
  return apart <= kGiven * max_;
}

// The same for several new vertices, with the same bits. Each test is a long chain of sums, with branches at its ends
// that cannot be predicted. So what has to be computed is listed first, and then computed for four vertices at once.
bool Certifier::are_all_oriented(Index begin, Index end) {
  BatchList list;
  for (Index v = begin; v < end; ++v) {
    const bool at_infinity = workspace_.at_infinity(v), is_free = workspace_.is_free(v);
    list.push_if(v, !is_free & !at_infinity);
    if (at_infinity && !is_free && !is_hull_facet(v)) return false;
  }
  for (const Index v : list.items()) workspace_.settle(v);
  BatchLooks seen;
  const double far = workspace_.exact() ? 0 : diameter_;
  list.for_each_four([&](std::size_t first, const std::array<Index, 4>& four) {
    take_volumes(four_volumes(tetrahedra(four)), first, seen);
    told_of_four(workspace_, four, far, &seen.radius[first], &seen.apart[first]);
  });
  see_four_spheres(list, seen);
  return are_listed_oriented(list, seen);
}

void Certifier::take_volumes(const FourVolumes& six, std::size_t first, BatchLooks& seen) {
  std::copy(six.value.begin(), six.value.end(), seen.negative.begin() + first);
  std::copy(six.bound.begin(), six.bound.end(), seen.negative_bound.begin() + first);
}

FourTetrahedra Certifier::tetrahedra(const std::array<Index, 4>& four) const {
  FourTetrahedra corners;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned lane = 0; lane < 4; ++lane) corners[i][lane] = &corner(four[lane], i);
  return corners;
}

// Does what from_seen_sphere() and then from_moved_sphere() do.
void Certifier::see_four_spheres(const BatchList& list, BatchLooks& seen) {
  const double enough = kTold * max_;
  see_far(list, seen, kHopelesslyTold * enough,
          [&](const std::array<Index, 4>& v, const std::array<Index, 4>& at, const auto& centers) {
            const FourOffCenters off = off_four_circumcenters(centers, tetrahedra(v));
            note_four(v, at, apart_of_four(workspace_, v, off, diameter_), seen);
          });
  see_far(list, seen, std::numeric_limits<double>::infinity(),
          [&](const std::array<Index, 4>& v, const std::array<Index, 4>& at, const auto& centers) {
            const FourOffCenters off = sharply_off_four_circumcenters(centers, tetrahedra(v));
            if (note_four(v, at, apart_of_four(workspace_, v, off, diameter_), seen)) return;
            const FourMoved moved = moved_four(workspace_, v, off, diameter_);
            for (unsigned lane = 0; lane < 4; ++lane) {
              if (seen.apart[at[lane]] <= enough || !(moved.apart[lane] <= enough)) continue;
              workspace_.place_by_bound(v[lane], Point(moved.x[lane], moved.y[lane], moved.z[lane]),
                                        moved.squared_radius[lane], moved.power_bound[lane]);
              seen.apart[at[lane]] = moved.apart[lane];
            }
          });
}

// Calls see(vertices, their places in the list, their centers) for four vertices at once, namely those that are farther
// from their own spheres than allowed, but not by more than this limit.
template <class See>
void Certifier::see_far(const BatchList& list, const BatchLooks& seen, double hopeless, const See& see) {
  BatchList far;  // places in the list
  for (Index at = 0; at < list.items().size(); ++at) {
    const bool is_far = seen.apart[at] > kTold * max_, is_hopeless = !(seen.apart[at] <= hopeless),
               is_positive = seen.negative[at] < -seen.negative_bound[at],
               shares = workspace_.shares_sphere(list.items()[at]);
    far.push_if(at, is_far & !is_hopeless & is_positive & !shares);
  }
  far.for_each_four([&](std::size_t, const std::array<Index, 4>& four) {
    std::array<Index, 4> v;
    std::array<const Point*, 4> centers;
    for (unsigned lane = 0; lane < 4; ++lane) {
      v[lane] = list.items()[four[lane]];
      centers[lane] = &workspace_.vertices[v[lane]].center;
    }
    see(v, four, centers);
  });
}

// Notes the results of four vertices. Returns whether all are near enough now.
bool Certifier::note_four(const std::array<Index, 4>& v, const std::array<Index, 4>& at, const FourSeen& found,
                          BatchLooks& seen) {
  bool all_near = true;
  for (unsigned lane = 0; lane < 4; ++lane) {
    const bool is_near = found.apart[lane] <= kTold * max_;
    if (is_near) workspace_.note_bound(v[lane], found.power_bound[lane]);
    seen.apart[at[lane]] = std::min(seen.apart[at[lane]], found.apart[lane]);
    all_near &= is_near;
  }
  return all_near;
}

bool Certifier::are_listed_oriented(const BatchList& list, const BatchLooks& seen) {
  BatchList rest;  // places in the list
  double given = 0, max_volume = found_.max_volume;
  Index fattest = found_.fattest;
  for (Index at = 0; at < list.items().size(); ++at) {
    const bool is_positive = seen.negative[at] < -seen.negative_bound[at], is_near = seen.apart[at] <= kTold * max_;
    const bool good = is_positive & is_near, is_fatter = good & (-seen.negative[at] > max_volume);
    rest.push_if(at, !good);
    given = std::max(given, good ? seen.apart[at] : 0);
    max_volume = is_fatter ? -seen.negative[at] : max_volume;
    fattest = is_fatter ? list.items()[at] : fattest;
  }
  found_.given = std::max(found_.given, given);
  found_.max_volume = max_volume;
  found_.fattest = fattest;
  bool good = true;
  rest.for_each_four([&](std::size_t first, const std::array<Index, 4>& four) {
    std::array<Index, 4> v;
    for (unsigned lane = 0; lane < 4; ++lane) v[lane] = list.items()[four[lane]];
    std::array<Vector, 4> centers;
    const unsigned found = four_sharp_circumcenters(tetrahedra(v), centers);
    for (unsigned lane = 0; lane < std::min<std::size_t>(rest.items().size() - first, 4); ++lane) {
      Look look{
          {seen.negative[four[lane]], seen.negative_bound[four[lane]]}, seen.apart[four[lane]], true, centers[lane]};
      if (((found >> lane) & 1u) == 0) look.has_center = own_center(v[lane], look.center);
      good = good && is_oriented(v[lane], look);
    }
  });
  return good;
}

// Whether three points are not on one line.
bool Certifier::is_triangle(const Point& a, const Point& b, const Point& c) {
  const Vector ab = b - a, ac = c - a;
  // The number of rounding errors in the two products of a component: two in the factors of each, one in each product,
  // and one in their difference. It is doubled to cover terms of second order.
  constexpr double kRoundings = 2 * 8 * kRounding;
  const double largest_product = ab.lpNorm<Eigen::Infinity>() * ac.lpNorm<Eigen::Infinity>();
  Vector normal;
  return ab.cross(ac).lpNorm<Eigen::Infinity>() > kRoundings * largest_product || sharp_normal(a, b, c, normal);
}

// Returns an upper bound on the distance between the sphere that a vertex was given and the sphere of its forming
// points, over all places where points may be.
double Certifier::from_own_sphere(Index v) const {
  const double told = from_told_sphere(v);
  if (told <= kTold * max_) return told;
  Vector center;
  return own_center(v, center) ? from_sphere(v, center) : diameter_;
}

// The same bound, computed from the distances of the forming points from the vertex's sphere. It is often much better,
// and is noted in that case.
double Certifier::from_seen_sphere(Index v) {
  return note_off(
      v, off_circumcenter(workspace_.vertices[v].center, corner(v, 3), corner(v, 0), corner(v, 1), corner(v, 2)));
}

double Certifier::note_off(Index v, const OffCenter& seen) {
  const double apart = apart_by(seen.off, std::sqrt(workspace_.vertices[v].radius));
  if (apart <= kTold * max_) workspace_.note_own_center(v, seen.off);
  return apart;
}

// The same with more digits. If the sphere is still too far off, the vertex is moved to its own sphere, if that is near
// enough.
double Certifier::from_moved_sphere(Index v) {
  const OffCenter seen =
      sharply_off_circumcenter(workspace_.vertices[v].center, corner(v, 3), corner(v, 0), corner(v, 1), corner(v, 2));
  const double before = note_off(v, seen);
  if (before <= kTold * max_) return before;
  const Point center = workspace_.vertices[v].center - seen.step;
  const double squared_radius = (center - corner(v, 0)).squaredNorm();
  const double rest = seen.rest + 2 * kRounding * center.lpNorm<1>();
  const double apart = apart_by(rest, std::sqrt(squared_radius));
  if (!(apart <= kTold * max_)) return before;
  workspace_.place_by_bound(v, center, squared_radius, Workspace::own_power_bound(center, squared_radius, rest));
  return apart;
}

// Returns the bound for a centre that is off by at most `off`, as from_sphere() does. The radius of the own sphere is
// at least three quarters of `radius`.
double Certifier::apart_by(double off, double radius) const {
  return off <= radius / 8 ? off * (4 * std::min(2.0, diameter_ / (0.75 * radius))) : diameter_;
}

bool Certifier::own_center(Index v, Vector& center) const {
  return sharp_circumcenter(corner(v, 0), corner(v, 1), corner(v, 2), corner(v, 3), center);
}

double Certifier::from_sphere(Index v, const Vector& center) const {
  // Both spheres pass through a common point. At distance d from it, powers differ by 2 d times the distance of the
  // centres.
  const double apart = (corner(v, 0) + center - workspace_.vertices[v].center).norm(), radius = center.norm();
  return apart <= radius / 2 ? 4 * apart * std::min(2.0, diameter_ / radius) : diameter_;
}

}  // namespace orchard::detail
