#include "detector/skip_pairs.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::detail {
namespace {

constexpr std::uint32_t kNoRecordYet = 0x80000000u;  // a bit that no place has

// Returns whether the spheres of the only parts of two bodies are apart, as sphere_gap() does, except that it allows
// slightly more for rounding. It has no branches, because no processor could predict them.
bool spheres_apart(const BoundingSphereCache& a, const BoundingSphereCache& b) noexcept {
  const Vec3 way = b.sphere.center - a.sphere.center;
  const double reach = (a.sphere.reach + b.sphere.reach) + kRoundingOfGaps * (a.slack + b.slack),
               square = dot(way, way);
  return static_cast<int>(square > reach * reach * (1 + 1e-14)) &
         static_cast<int>(square <= std::numeric_limits<double>::max());
}

}  // namespace

RelativePlacement PairSkipper::relative_placement(const BodyPair& pair) const noexcept {
  const BoundingSphereCache& a = world_.bodies.sphere_cache(pair.a);
  if (is_half_space(pair.b)) return {a.slack, -1.0 * a.sphere.center, a.turned, a.changes};
  const BoundingSphereCache& b = world_.bodies.sphere_cache(pair.b);
  return {a.slack + b.slack, b.sphere.center - a.sphere.center, a.turned + b.turned, a.changes + b.changes};
}

// Returns whether the bodies have come closer to each other since the last certain "no" by less than their distance
// then. If the direction of that distance is known, only the motion along it counts; otherwise, the whole motion does.
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

// Returns whether each part of one body is apart from each part of the other. It is for bodies of several parts, and
// returns false for others.
bool PairSkipper::parts_apart(const BodyPair& pair) const noexcept {
  const Body &a = world_.bodies[pair.a], &b = world_.bodies[pair.b];
  if (!world_.any.parts || (a.several.empty() && b.several.empty()) || !a.valid || !b.valid || a.is_continuous() ||
      b.is_continuous())
    return false;
  for (const PartRecord& p : a.parts()) {
    for (const PartRecord& q : b.parts()) {
      if (!(sphere_gap(p.sphere, q.sphere).least > 0)) return false;
    }
  }
  return true;
}

// Writes to `near` the places in [begin, end) of the pairs that may not be skipped. A pair is skipped if its clearance
// shows that it is apart or, unless it is busy, if its spheres do. kNoRecordYet is added to the places of pairs without
// a record. Returns the number of places.
std::size_t PairSkipper::find_near(PairCache& cache, std::size_t begin, std::size_t end,
                                   std::uint32_t* near) const noexcept {
  constexpr std::size_t kAhead = 16;
  const BodyPair* const pairs = &cache.pair(0);
  std::size_t found = 0, count = 0;
  for (std::size_t place = begin; place < end; ++place) {
    if (place + kAhead < end) world_.bodies.prefetch_sphere_cache(pairs[place + kAhead].b);
    const BodyPair& pair = pairs[place];
    const bool apart =
        !is_half_space(pair.b) && spheres_apart(world_.bodies.sphere_cache(pair.a), world_.bodies.sphere_cache(pair.b));
    near[found] = static_cast<std::uint32_t>(place);
    found += static_cast<std::size_t>(cache.busy(place)) | static_cast<std::size_t>(!apart);
  }
  for (std::size_t i = 0; i < found; ++i) {
    if (i + kAhead < found) cache.prefetch_known(near[i + kAhead]);
    const BodyPair& pair = pairs[near[i]];
    const BoundingSphere& sphere = world_.bodies.sphere_cache(pair.a).sphere;
    if (!cache.busy(near[i]) &&
        (is_half_space(pair.b) ? sphere_gap(sphere, world_.places.half_space(pair.b)).least > 0 : parts_apart(pair)))
      continue;
    auto& known = cache.known(near[i]);
    if (known.clearance.distance > 0 && moved_less_than_gap(known)) continue;
    known.clearance.distance = 0;
    near[count++] = near[i] | (known.record == kNoRecord ? kNoRecordYet : 0);
  }
  return count;
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

bool PairSkipper::needs_answer(CachedPair& pair, Step step, bool interrupted) const noexcept {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  pair.turn.importance = std::max(a.options.importance, b.options.importance);
  if (!pair.versions.allowed) return false;
  const bool continuous = a.is_continuous() || b.is_continuous();
  const std::uint32_t jumps = a.changes.jumps + b.changes.jumps;
  const auto known_before = [&](const Body& body) {
    return body.is_static || (body.frozen && body.steps.asked < step) || body.steps.known_before == step - 1;
  };
  pair.sweep.possible = continuous && pair.versions.jumps == jumps && known_before(a) && known_before(b);
  // The sphere of a continuous body reaches as far as the body can move in a step. So if a body was not sampled at the
  // step before, nothing was near it then, unless the broad phase was interrupted or the parts of a body reach farther
  // out now. A new body was not there at the step before, so no sweep of it is missing.
  const bool sphere_fell_short = interrupted || a.stretched == step - 1 || b.stretched == step - 1;
  const bool both_before = std::max(a.since, b.since) < step;
  pair.sweep.unseen =
      continuous && pair.versions.jumps == jumps && !pair.sweep.possible && sphere_fell_short && both_before;
  pair.versions.jumps = jumps;
  if (pair.versions.deformed != a.changes.deformed + b.changes.deformed) {
    pair.versions.deformed = a.changes.deformed + b.changes.deformed;
    pair.trees.forget();
  }
  const bool rest = pair.answered >= 0 && std::max(a.steps.moved, b.steps.moved) <= pair.answered;
  return !rest || pair.sweep.impact;
}

// A pair with a continuous body keeps no clearance, because it is swept at each step.
void PairSkipper::keep_clearance(PairCache::Known& known, const CachedPair& pair) const noexcept {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  const bool lasts = pair.verdict.answer == Answer::no && !pair.touching && !a.is_continuous() && !b.is_continuous() &&
                     a.valid && b.valid && std::isfinite(pair.verdict.lower_bound);
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
  if (dot(pair.apart_along, pair.apart_along) > 0 && std::isfinite(reach)) {
    kept.along = rounded(pair.apart_along);
    distance -= kRoundedToFloat * (way + reach);  // no two of their points are farther apart than that
  }
  kept.distance = distance > 0 ? distance : 0;
  kept.way = rounded(now.way);
  kept.turned = now.turned, kept.changes = now.changes;
}

}  // namespace orchard::runtime::detail
