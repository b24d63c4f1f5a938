#include "detector/skip_pairs.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::detail {
namespace {

constexpr std::uint32_t kNoRecordYet = 0x80000000u;  // beyond all places

// Whether the spheres of their only parts are apart; as sphere_gap() says, or not quite. No branches: no
// processor predicts them.
bool spheres_apart(const BoundingSphereCache& a, const BoundingSphereCache& b) noexcept {
  const Vec3 way = b.sphere.center - a.sphere.center;
  const double reach = (a.sphere.reach + b.sphere.reach) + kRoundingOfGaps * (a.slack + b.slack),
               square = dot(way, way);
  return static_cast<int>(square > reach * reach * (1 + 1e-14)) &
         static_cast<int>(square <= std::numeric_limits<double>::max());
}

// Then they are so for spheres_apart(), too.
bool float_spheres_apart(const FloatSphere& a, const FloatSphere& b) noexcept {
  const float x = b.x - a.x, y = b.y - a.y, z = b.z - a.z, reach = a.radius + b.radius;
  return x * x + y * y + z * z > reach * reach;
}

// Whether each part of the one is apart from each of the other.
bool parts_apart(std::span<const FloatSphere> a, std::span<const FloatSphere> b) noexcept {
  for (const FloatSphere& q : b) {
    for (const FloatSphere& p : a) {
      if (!float_spheres_apart(p, q)) return false;
    }
  }
  return true;
}

}  // namespace

RelativePlacement PairSkipper::relative_placement(const BodyPair& pair) const noexcept {
  const BoundingSphereCache& a = world_.bodies.sphere_cache(pair.a);
  if (is_half_space(pair.b)) return {a.slack, -1.0 * a.sphere.center, a.turned, a.changes};
  const BoundingSphereCache& b = world_.bodies.sphere_cache(pair.b);
  return {a.slack + b.slack, b.sphere.center - a.sphere.center, a.turned + b.turned, a.changes + b.changes};
}

// Whether they have come closer since the last certain "no" by less than what was between them then: in the direction
// in which that was, if it is known; else in any.
bool PairSkipper::moved_less_than_gap(const PairCache::Known& known) const noexcept {
  const RelativePlacement now = relative_placement(known.pair);
  const Clearance& then = known.clearance;
  const double turned = (now.turned - then.turned) * (1 + kRoundedToFloat);
  const double left = then.distance * (1 - 1e-9) - now.slack - turned;
  const Vec3 moved = now.way - Vec3{then.way[0], then.way[1], then.way[2]};
  const Vec3 along = {then.along[0], then.along[1], then.along[2]};
  if (dot(along, along) > 0) return now.changes == then.changes && left + dot(along, moved) > 0;
  return now.changes == then.changes && left > 0 && dot(moved, moved) < left * left * (1 - 1e-9);
}

bool PairSkipper::sphere_above(const BodyPair& pair) const noexcept {
  const BoundingSphereCache& a = world_.bodies.sphere_cache(pair.a);
  const HalfSpace& half = world_.places.half_space(pair.b);
  const double height = dot(half.normal, a.sphere.center) - half.offset - a.sphere.reach;
  return height > kRoundingOfGaps * (a.slack + 1e-14 * std::fabs(half.offset)) && std::isfinite(height);
}

// Those of cache.pair(begin .. end - 1) that their spheres in floats do not tell apart, and those whose records would
// be changed by that. Of bodies with several parts each part's sphere is looked at, if there are such bodies.
template <bool kParts>
std::size_t PairSkipper::find_near_spheres(const PairCache& cache, std::size_t begin, std::size_t end,
                                           std::uint32_t* near) const noexcept {
  constexpr std::size_t kAhead = 24;
  const BodyPair* const pairs_of = &cache.pair(0);
  std::size_t found = 0;
  for (std::size_t place = begin; place < end;) {
    const BodyIndex first = pairs_of[place].a;
    const FloatSphere a = world_.bodies.float_sphere(first);
    const auto look_at = [&](BodyIndex second) ORCHARD_INLINE_LAMBDA {
      bool apart = !is_half_space(second) && float_spheres_apart(a, world_.bodies.float_sphere(second));
      if constexpr (kParts) {
        apart =
            apart || (!is_half_space(second) && world_.bodies.either_has_parts({first, second}) &&
                      parts_apart(world_.bodies.float_part_spheres(first), world_.bodies.float_part_spheres(second)));
      }
      near[found] = static_cast<std::uint32_t>(place);
      found += static_cast<std::size_t>(cache.busy(place)) | static_cast<std::size_t>(!apart);
    };
    for (; place + kAhead < end && pairs_of[place].a == first; ++place) {
      world_.bodies.prefetch_float_sphere(pairs_of[place + kAhead].b);
      look_at(pairs_of[place].b);
    }
    for (; place < end && pairs_of[place].a == first; ++place) look_at(pairs_of[place].b);
  }
  return found;
}

// Those of cache.pair(begin .. end - 1) that their spheres do not tell apart, nor what is known of them, or whose
// records would be changed by that. Plus kNoRecordYet where there is none.
std::size_t PairSkipper::find_near(PairCache& cache, std::size_t begin, std::size_t end,
                                   std::uint32_t* near) const noexcept {
  std::size_t found = world_.bodies.any_parts() ? find_near_spheres<true>(cache, begin, end, near)
                                                : find_near_spheres<false>(cache, begin, end, near),
              count_near = 0;
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < found; ++i) {
    if (i + kAhead < found) cache.prefetch_known(near[i + kAhead]);
    if (i + kAhead < found) world_.bodies.prefetch_sphere_cache(cache.pair(near[i + kAhead]).b);
    const BodyPair& pair = cache.pair(near[i]);
    if (!cache.busy(near[i]) &&
        (is_half_space(pair.b) ? sphere_above(pair)
                               : spheres_apart(world_.bodies.sphere_cache(pair.a), world_.bodies.sphere_cache(pair.b))))
      continue;
    auto& known = cache.known(near[i]);
    if (known.clearance.distance > 0 && moved_less_than_gap(known)) continue;
    known.clearance.distance = 0;
    near[count_near++] = near[i] | (known.record == kNoRecord ? kNoRecordYet : 0);
  }
  return count_near;
}

ActivePairs PairSkipper::find_active(PairCache& cache) {
  constexpr std::size_t kPerJob = 1024;
  const std::size_t among = cache.size(), jobs = (among + kPerJob - 1) / kPerJob;
  grow(active_, among);
  grow(active_of_job_, jobs);
  auto look_at_some = [&](std::size_t job) {
    const std::size_t begin = job * kPerJob;
    active_of_job_[job] = find_near(cache, begin, std::min(among, begin + kPerJob), &active_[begin]);
  };
  run_jobs(world_.options.executor, jobs, look_at_some);
  std::size_t count = 0;
  auto kept = cache.kept().begin();
  for (std::size_t job = 0; job < jobs; ++job) {
    for (std::size_t i = 0; i < active_of_job_[job]; ++i) {
      const std::uint32_t found = active_[job * kPerJob + i], place = found & ~kNoRecordYet;
      while (kept != cache.kept().end() && *kept < place) ++kept;
      if (kept != cache.kept().end() && *kept == place) continue;
      active_[count++] = place;
      if (found != place) cache.take(place);
    }
  }
  return {cache, world_.places, std::span(active_).first(count)};
}

// Neither has moved since the last certain answer.
bool PairSkipper::rest(const CachedPair& pair) const noexcept {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  return pair.answered >= 0 && std::max(a.moved, b.moved) <= pair.answered && !pair.sweep.impact;
}

bool PairSkipper::needs_answer(CachedPair& pair, Step step, bool interrupted) const noexcept {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  pair.turn.importance = std::max(a.importance, b.importance);
  if (!pair.versions.allowed) return false;
  const bool continuous = a.continuous_speed > 0 || b.continuous_speed > 0;
  const std::uint32_t jumps = a.jumps + b.jumps;
  const auto known_before = [&](const Body& body) {
    return body.is_static || (body.frozen && body.asked < step) || body.known_before == step - 1;
  };
  pair.sweep.possible = continuous && pair.versions.jumps == jumps && known_before(a) && known_before(b);
  // As spheres reach as far as a step leads, a body that was not sampled at the step before had nothing near it then:
  // unless the broad phase was interrupted, or the body's parts go farther now. Nothing was between it and a new body.
  const bool sphere_fell_short = interrupted || a.stretched == step - 1 || b.stretched == step - 1;
  const bool both_before = std::max(a.since, b.since) < step;
  pair.sweep.unseen =
      continuous && pair.versions.jumps == jumps && !pair.sweep.possible && sphere_fell_short && both_before;
  pair.versions.jumps = jumps;
  if (pair.versions.deformed != a.deformed + b.deformed) {
    pair.versions.deformed = a.deformed + b.deformed;
    pair.trees.forget();
  }
  return !rest(pair);
}

// After a certain "no". What is swept is asked at each step.
void PairSkipper::keep_clearance(PairCache::Known& known, const CachedPair& pair) const noexcept {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  const bool lasts = pair.verdict.answer == Answer::no && !pair.touching && !(a.continuous_speed > 0) &&
                     !(b.continuous_speed > 0) && a.valid && b.valid && std::isfinite(pair.verdict.lower_bound);
  if (!lasts) return;
  const RelativePlacement now = relative_placement(known.pair);
  const double way = length(now.way);
  double distance = pair.verdict.lower_bound - now.slack - kRoundedToFloat * way;
  Clearance& kept = known.clearance;
  const auto rounded = [](const Vec3& v) -> Clearance::Floats {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  };
  kept.along = {};
  const double reach = is_half_space(known.pair.b) ? std::numeric_limits<double>::infinity()
                                                   : world_.bodies.sphere_cache(known.pair.a).sphere.reach +
                                                         world_.bodies.sphere_cache(known.pair.b).sphere.reach;
  if (dot(pair.apart.along, pair.apart.along) > 0 && std::isfinite(reach)) {
    kept.along = rounded(pair.apart.along);
    distance -= kRoundedToFloat * (way + reach);  // no two of their points are farther from each other
  }
  kept.distance = distance > 0 ? distance : 0;
  kept.way = rounded(now.way);
  kept.turned = now.turned, kept.changes = now.changes;
}

}  // namespace orchard::runtime::detail
