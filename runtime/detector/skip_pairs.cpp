#include <algorithm>
#include <cmath>

#include "detector/detector_state.h"

// Which pairs may be skipped at a step: those whose spheres are apart, and those that have moved less since a certain
// "no" than they were apart then.
namespace orchard::runtime {
namespace {

constexpr std::uint32_t kNoRecordYet = 0x80000000u;  // beyond all places

// Whether the spheres of their only parts are apart; as sphere_gap() says, or not quite. No branches: nobody foresees
// them.
bool spheres_apart(const detail::Whereabouts& a, const detail::Whereabouts& b) noexcept {
  const Vec3 way = b.middle - a.middle;
  const double reach = (a.reach + b.reach) + detail::kRoundingOfGaps * (a.slack + b.slack), square = dot(way, way);
  return static_cast<int>(square > reach * reach * (1 + 1e-14)) &
         static_cast<int>(square <= std::numeric_limits<double>::max());
}

// Then they are so for spheres_apart(), too.
bool near_spheres_apart(const detail::NearSphere& a, const detail::NearSphere& b) noexcept {
  const float x = b.x - a.x, y = b.y - a.y, z = b.z - a.z, reach = a.radius + b.radius;
  return x * x + y * y + z * z > reach * reach;
}

// Whether each part of the one is apart from each of the other.
bool parts_apart(std::span<const detail::NearSphere> a, std::span<const detail::NearSphere> b) noexcept {
  for (const detail::NearSphere& q : b) {
    for (const detail::NearSphere& p : a) {
      if (!near_spheres_apart(p, q)) return false;
    }
  }
  return true;
}

}  // namespace

using detail::is_half_space;

detail::Standing Detector::State::standing(const BodyPair& pair) const noexcept {
  const detail::Whereabouts& a = bodies.whereabouts(pair.a);
  if (is_half_space(pair.b)) return {a.slack, -1.0 * a.middle, a.turned, a.changes};
  const detail::Whereabouts& b = bodies.whereabouts(pair.b);
  return {a.slack + b.slack, b.middle - a.middle, a.turned + b.turned, a.changes + b.changes};
}

// Whether they have come closer since the last certain "no" by less than what was between them then: in the direction
// in which that was, if it is known; else in any.
bool Detector::State::clear(const detail::RecordTable::Known& known) const noexcept {
  const detail::Standing now = standing(known.pair);
  const detail::Clearance& then = known.clearance;
  const double turned = (now.turned - then.turned) * (1 + detail::kRoundedToFloat);
  const double left = then.distance * (1 - 1e-9) - now.slack - turned;
  const Vec3 moved = now.way - Vec3{then.way[0], then.way[1], then.way[2]};
  const Vec3 along = {then.along[0], then.along[1], then.along[2]};
  if (dot(along, along) > 0) return now.changes == then.changes && left + dot(along, moved) > 0;
  return now.changes == then.changes && left > 0 && dot(moved, moved) < left * left * (1 - 1e-9);
}

bool Detector::State::sphere_above(const BodyPair& pair) const noexcept {
  const detail::Whereabouts& a = bodies.whereabouts(pair.a);
  const detail::HalfSpace& half = places.half_space(pair.b);
  const double height = dot(half.normal, a.middle) - half.offset - a.reach;
  return height > detail::kRoundingOfGaps * (a.slack + 1e-14 * std::fabs(half.offset)) && std::isfinite(height);
}

// Those of records.pair(begin .. end - 1) that their spheres in floats do not tell apart, and those whose records would
// be changed by that. Of bodies with several parts each part's sphere is looked at, if there are such bodies.
template <bool kParts>
std::size_t Detector::State::find_near_spheres(std::size_t begin, std::size_t end, std::uint32_t* near) const noexcept {
  constexpr std::size_t kAhead = 24;
  const BodyPair* const pairs_of = &records.pair(0);
  std::size_t found = 0;
  for (std::size_t place = begin; place < end;) {
    const BodyIndex first = pairs_of[place].a;
    const detail::NearSphere a = bodies.near_sphere(first);
    const auto look_at = [&](BodyIndex second) ORCHARD_INLINE_LAMBDA {
      bool apart = !is_half_space(second) && near_spheres_apart(a, bodies.near_sphere(second));
      if constexpr (kParts) {
        apart = apart || (!is_half_space(second) && bodies.either_has_parts({first, second}) &&
                          parts_apart(bodies.near_part_spheres(first), bodies.near_part_spheres(second)));
      }
      near[found] = static_cast<std::uint32_t>(place);
      found += static_cast<std::size_t>(records.busy(place)) | static_cast<std::size_t>(!apart);
    };
    for (; place + kAhead < end && pairs_of[place].a == first; ++place) {
      bodies.prefetch_near_sphere(pairs_of[place + kAhead].b);
      look_at(pairs_of[place].b);
    }
    for (; place < end && pairs_of[place].a == first; ++place) look_at(pairs_of[place].b);
  }
  return found;
}

// Those of records.pair(begin .. end - 1) that their spheres do not tell apart, nor what is known of them, or whose
// records would be changed by that. Plus kNoRecordYet where there is none.
std::size_t Detector::State::find_near(std::size_t begin, std::size_t end, std::uint32_t* near) noexcept {
  std::size_t found = bodies.any_parts() ? find_near_spheres<true>(begin, end, near)
                                         : find_near_spheres<false>(begin, end, near),
              count_near = 0;
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < found; ++i) {
    if (i + kAhead < found) records.prefetch_known(near[i + kAhead]);
    if (i + kAhead < found) bodies.prefetch_whereabouts(records.pair(near[i + kAhead]).b);
    const BodyPair& pair = records.pair(near[i]);
    if (!records.busy(near[i]) &&
        (is_half_space(pair.b) ? sphere_above(pair)
                               : spheres_apart(bodies.whereabouts(pair.a), bodies.whereabouts(pair.b))))
      continue;
    auto& known = records.known(near[i]);
    if (known.clearance.distance > 0 && clear(known)) continue;
    known.clearance.distance = 0;
    near[count_near++] = near[i] | (known.record == detail::kNoRecord ? kNoRecordYet : 0);
  }
  return count_near;
}

// The pairs that have to be asked about, and a record for each of these.
void Detector::State::find_active() {
  constexpr std::size_t kPerJob = 1024;
  const std::size_t among = records.size(), jobs = (among + kPerJob - 1) / kPerJob;
  detail::grow(active, among);
  detail::grow(active_of_job, jobs);
  auto look_at_some = [&](std::size_t job) {
    const std::size_t begin = job * kPerJob;
    active_of_job[job] = find_near(begin, std::min(among, begin + kPerJob), &active[begin]);
  };
  run_jobs(options.executor, jobs, look_at_some);
  active_count = 0;
  auto kept = records.kept().begin();
  for (std::size_t job = 0; job < jobs; ++job) {
    for (std::size_t i = 0; i < active_of_job[job]; ++i) {
      const std::uint32_t found = active[job * kPerJob + i], place = found & ~kNoRecordYet;
      while (kept != records.kept().end() && *kept < place) ++kept;
      if (kept != records.kept().end() && *kept == place) continue;
      active[active_count++] = place;
      if (found != place) records.take(place);
    }
  }
}

}  // namespace orchard::runtime
