#include "detector/match_pairs.h"

namespace orchard::runtime::detail {

void PairMatcher::gather(Step step, const Advance& now) {
  pairs_.clear();
  gather_half_spaces(step);
  if (now.incomplete_from != kNoClass) gather_left_out(step, now);
  part_pairs_.find(step, cache_, pairs_.by_parts);
  pairs_.merge(now.pairs);
  sampler_.sample_pairs(step, pairs_.all());
}

void PairMatcher::gather_half_spaces(Step step) {
  due_.clear();
  world_.half_space_times.due(step, due_);
  if (due_.empty()) return;
  sampler_.sample(step, due_);
  for (const BodyIndex body : due_) {
    world_.half_space_times.update(world_.bodies[body], step, world_.clock,
                                   sampler_.given_motion(body, world_.clock.time(step)), world_.options.position_slack,
                                   pairs_.with_planes);
  }
}

void PairMatcher::gather_left_out(Step step, const Advance& now) {
  std::vector<BodyPair>& kept = pairs_.kept;
  auto reported = now.pairs.begin();
  for (std::size_t place = 0; place < cache_.size(); ++place) {
    const BodyPair& pair = cache_.pair(place);
    if (is_half_space(pair.b) || part_pairs_.finds(pair)) continue;
    while (reported != now.pairs.end() && *reported < pair) ++reported;
    if (reported != now.pairs.end() && *reported == pair) continue;
    if (world_.bodies.are_there(pair, cache_.known(place).generations)) kept.push_back(pair);
  }
  left_out_.clear();
  for (const BodyPair& pair : kept) left_out_.push_back(pair.a), left_out_.push_back(pair.b);
  sampler_.sample(step, left_out_);
  std::erase_if(kept, [&](const BodyPair& pair) {
    const double dt = world_.clock.time_step;
    const Motion a = world_.bodies[pair.a].motion(dt), b = world_.bodies[pair.b].motion(dt);
    return a.radius >= 0 && b.radius >= 0 && !spheres_touch(a, b);
  });
}

CachedPair& PairMatcher::cached(PairCache::Known& known) {
  if (cache_.is_begun(known)) return cache_[known.record];
  CachedPair& pair = cache_.begin(known);
  pair.bodies = known.pair;
  const Body &a = world_.places.body(known.pair.a), &b = world_.places.body(known.pair.b);
  pair.a = a.id, pair.b = b.id;
  pair.versions.pair_filter = world_.filter_version - 1;
  pair.versions.jumps = a.changes.jumps + b.changes.jumps;
  pair.versions.deformed = a.changes.deformed + b.changes.deformed;
  if (a.parts.size() != 1 || b.parts.size() != 1) return pair;
  const Shape &of_a = world_.shapes[a.parts[0].shape], &of_b = world_.shapes[b.parts[0].shape];
  pair.coherent = of_a.has_tree() && of_b.has_tree();
  if (pair.coherent) pair.trees = TreePair(of_a.prepared, of_b.prepared);
  return pair;
}

bool PairMatcher::allowed(CachedPair& pair) const {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  if (pair.versions.pair_filter == world_.filter_version && pair.versions.filter_a == a.changes.filters &&
      pair.versions.filter_b == b.changes.filters) {
    return pair.versions.allowed;
  }
  pair.versions.pair_filter = world_.filter_version;
  pair.versions.filter_a = a.changes.filters, pair.versions.filter_b = b.changes.filters;
  pair.versions.allowed = filters_allow(a, b) && (!world_.filter || world_.filter(pair.a, pair.b));
  return pair.versions.allowed;
}

}  // namespace orchard::runtime::detail
