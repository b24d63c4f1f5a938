#include "orchard/runtime/broad_queries.h"

#include <algorithm>
#include <cmath>

#include "broad_phase/broad_phase_state.h"

namespace orchard::runtime {
namespace {

using detail::Near;

constexpr std::size_t kAskedAtOnce = 64;
constexpr double kFirstReach = 0.5;       // in cells; half the width of the cube that nearest() searches first
constexpr double kQueryRounding = 1e-12;  // relative to coordinates; more than the rounding errors of the tests

bool fits(double x) noexcept { return std::fabs(x) <= kMaxNumber; }  // not NaN
bool fits(const Vec3& v) noexcept { return fits(v[0]) && fits(v[1]) && fits(v[2]); }
double max_coordinate(const Vec3& v) noexcept { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }
bool is_line(const Ray& ray) noexcept {
  const Vec3 direction = ray.direction;
  return fits(Vec3(ray.origin)) && fits(direction) && max_coordinate(direction) > 0 && ray.longest >= 0;
}
bool admits(const QueryFilter& query, const BodyFilter& body) noexcept {
  return (query.mask & body.category) != 0 && (query.category & body.mask) != 0;
}

// Returns the distance of the point from the box.
double distance_to_box(const Vec3& lower, const Vec3& upper, const Vec3& point) noexcept {
  Vec3 off;
  for (std::size_t d = 0; d < 3; ++d) off[d] = point[d] - std::clamp(point[d], lower[d], upper[d]);
  return length(off);
}

}  // namespace

// A line of a query. A direction of 0 makes it a point of length 0, whose `way` does not matter.
struct BodyQueries::Line {
  Vec3 origin, way;
  double unit, length;  // the length of a unit of `along`, and the length of the line

  Line(const Vec3& from, const Vec3& direction, double longest) noexcept : origin(from), way{1, 0, 0} {
    const double size = max_coordinate(direction);  // the squares of very small numbers underflow
    const Vec3 scaled = size > 0 ? (1 / size) * direction : Vec3{};
    const double norm = runtime::length(scaled);
    if (size > 0) way = (1 / norm) * scaled;
    unit = size * norm;
    length = size > 0 ? longest * unit : 0;
  }

  // Returns the distance along the line at which it enters the sphere, or infinity if it does not.
  double enters(const Vec3& center, double radius) const noexcept {
    const Vec3 to_center = center - origin;
    if (dot(to_center, to_center) <= radius * radius) return 0;
    const double middle = dot(to_center, way), never = std::numeric_limits<double>::infinity();
    const Vec3 off = to_center - middle * way;
    const double room = radius * radius - dot(off, off);
    if (!(room >= 0) || middle < 0) return never;
    const double at = std::max(0.0, middle - std::sqrt(room));
    return at <= length ? at : never;
  }
  double along(double at) const noexcept { return unit > 0 ? at / unit : 0; }
};

// Returns the step that queries are about.
std::int64_t BodyQueries::step() const noexcept { return std::max<detail::Step>(0, world_->step_reported()); }

double BodyQueries::time() const noexcept { return world_->state_->pool.clock.time(step()); }

bool BodyQueries::begin(bool valid) {
  refused_ = !valid || !world_->may_change();
  if (world_->state_->busy) return false;  // a query of this object may be under way
  candidates_.clear(), found_.clear(), hits_.clear(), near_.clear();
  if (refused_) return false;
  detail::grow(seen_, world_->state_->pool.slots());
  if (++query_ == 0) {  // all numbers have been used
    std::fill(seen_.begin(), seen_.end(), 0);
    query_ = 1;
  }
  return true;
}

// Returns the bodies that exist, that the filter admits and that have not come up in this query yet.
std::span<const BodyIndex> BodyQueries::new_ones(std::span<const BodyIndex> bodies, const QueryFilter& filter) {
  const detail::BodyPool& pool = world_->state_->pool;
  asked_.clear();
  for (const BodyIndex body : bodies) {
    if (seen_[body] == query_ || !pool.alive(body)) continue;
    seen_[body] = query_;
    if (admits(filter, pool.filters.of(body))) asked_.push_back(body);
  }
  return asked_;
}

// Calls use(body, motion) for each of the new_ones() with a valid motion, which is that at time().
template <typename Use>
void BodyQueries::use_motions(std::span<const BodyIndex> bodies, const QueryFilter& filter, const Use& use) {
  std::span<const BodyIndex> rest = new_ones(bodies, filter);
  const detail::Step now = step();
  motions_.resize(kAskedAtOnce);
  while (!rest.empty()) {
    const std::size_t count = std::min(kAskedAtOnce, rest.size());
    {
      const BroadPhase::Busy busy(*world_->state_);
      world_->state_->pool.motions.ask(now, rest.first(count), std::span(motions_).first(count));
    }
    refused_ = false;  // queries that the source has tried meanwhile were refused, but not this one
    for (std::size_t i = 0; i < count; ++i) {
      if (is_valid(motions_[i])) use(rest[i], motions_[i]);
    }
    rest = rest.subspan(count);
  }
}

std::span<const BodyIndex> BodyQueries::all_bodies() {
  candidates_.clear();
  for (BodyIndex body = 0; body < world_->state_->pool.slots(); ++body) candidates_.push_back(body);
  return candidates_;
}

// Returns the hits of all bodies on the line or, if `first` is set, those of bodies that may be the first one, with the
// distance as BodyHit::along.
std::span<const BodyHit> BodyQueries::along(const Line& line, const QueryFilter& filter, bool first) {
  double best = std::numeric_limits<double>::infinity();
  const auto visit = [&](std::span<const BodyIndex> bodies, double until) {
    use_motions(bodies, filter, [&](BodyIndex body, const Motion& motion) {
      const double at = line.enters(motion.position, motion.radius);
      if (at > best || at == std::numeric_limits<double>::infinity()) return;
      if (first) best = at;
      hits_.push_back({body, first ? at : line.along(at)});
    });
    return !(best < until);
  };
  const detail::BroadPhaseAlgorithm& method = *world_->state_->method;
  if (!method.along(step(), line.origin, line.way, line.length, candidates_, std::ref(visit)))
    visit(all_bodies(), line.length);
  std::sort(hits_.begin(), hits_.end(), [](const BodyHit& a, const BodyHit& b) {
    return a.along != b.along ? a.along < b.along : a.body < b.body;
  });
  return hits_;
}

std::optional<BodyHit> BodyQueries::first_along(const Line& line, const QueryFilter& filter) {
  const std::span<const BodyHit> hits = along(line, filter, true);
  if (hits.empty()) return {};
  return BodyHit{hits[0].body, line.along(hits[0].along)};
}

std::optional<BodyHit> BodyQueries::first_hit(const Ray& ray, const QueryFilter& filter) {
  if (!begin(is_line(ray))) return {};
  return first_along({ray.origin, ray.direction, ray.longest}, filter);
}

std::optional<BodyHit> BodyQueries::first_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter) {
  if (!begin(fits(p) && fits(q))) return {};
  return first_along({p, q - p, 1}, filter);
}

std::span<const BodyHit> BodyQueries::all_hits(const Ray& ray, const QueryFilter& filter) {
  if (!begin(is_line(ray))) return {};
  return along({ray.origin, ray.direction, ray.longest}, filter, false);
}

std::span<const BodyHit> BodyQueries::all_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter) {
  if (!begin(fits(p) && fits(q))) return {};
  return along({p, q - p, 1}, filter, false);
}

// Returns the bodies for which touches(motion) is true, among those whose spheres may meet the box.
template <typename Touches>
std::span<const BodyIndex> BodyQueries::touching(const Vec3& lower, const Vec3& upper, const QueryFilter& filter,
                                                 const Touches& touches) {
  const double spare = kQueryRounding * std::max(max_coordinate(lower), max_coordinate(upper));
  const Vec3 wider = {spare, spare, spare};
  const Near near = world_->state_->method->near_box(step(), lower - wider, upper + wider, candidates_);
  use_motions(near == Near::untold ? all_bodies() : candidates_, filter, [&](BodyIndex body, const Motion& motion) {
    if (touches(motion)) found_.push_back(body);
  });
  std::sort(found_.begin(), found_.end());
  return found_;
}

std::span<const BodyIndex> BodyQueries::touching_sphere(const Vec3& center, double radius, const QueryFilter& filter) {
  if (!begin(fits(center) && fits(radius) && radius >= 0)) return {};
  const Motion sphere{.position = center, .radius = radius};
  const Vec3 reach = {radius, radius, radius};
  return touching(center - reach, center + reach, filter,
                  [&](const Motion& motion) { return spheres_touch(sphere, motion); });
}

std::span<const BodyIndex> BodyQueries::touching_box(const Vec3& lower, const Vec3& upper, const QueryFilter& filter) {
  const bool valid = lower[0] <= upper[0] && lower[1] <= upper[1] && lower[2] <= upper[2];
  if (!begin(fits(lower) && fits(upper) && valid)) return {};
  return touching(lower, upper, filter, [&](const Motion& motion) {
    return distance_to_box(lower, upper, motion.position) <= motion.radius;
  });
}

// Searches cubes, each twice as large as the one before, until the k-th body is nearer than the faces of the cube.
std::span<const NearBody> BodyQueries::nearest(const Vec3& point, std::size_t k, const QueryFilter& filter) {
  if (!begin(fits(point))) return {};
  k = std::min(k, world_->size());
  if (k == 0) return {};
  const detail::BroadPhaseAlgorithm& method = *world_->state_->method;
  const auto nearer = [](const NearBody& a, const NearBody& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.body < b.body;
  };
  const auto note = [&](BodyIndex body, const Motion& motion) {
    near_.push_back({body, std::max(0.0, length(motion.position - point) - motion.radius)});
  };
  const double spare = kQueryRounding * max_coordinate(point);
  double reach = kFirstReach * method.cell_size() * std::cbrt(static_cast<double>(k)) + spare;
  for (Near covered = Near::some; covered == Near::some; reach *= 2) {
    const Vec3 wide = {reach + 2 * spare, reach + 2 * spare, reach + 2 * spare};
    candidates_.clear();
    covered = reach > 0 && reach < kMaxNumber ? method.near_box(step(), point - wide, point + wide, candidates_)
                                              : Near::untold;
    use_motions(covered == Near::untold ? all_bodies() : candidates_, filter, note);
    if (near_.size() < k) continue;
    std::nth_element(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(k) - 1, near_.end(), nearer);
    if (near_[k - 1].distance <= reach * (1 - kQueryRounding)) break;
  }
  const std::size_t count = std::min(k, near_.size());
  std::sort(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(count), nearer);
  return std::span(near_).first(count);
}

std::size_t BodyQueries::memory_bytes() const noexcept {
  return detail::bytes_of(seen_, candidates_, asked_, found_, motions_, hits_, near_);
}

}  // namespace orchard::runtime
