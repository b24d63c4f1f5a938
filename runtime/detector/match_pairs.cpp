#include "detector/match_pairs.h"

#include <algorithm>

namespace orchard::runtime::detail {

void PairMatcher::gather(Step step, const Advance& now) {
  others_.clear();
  if (now.incomplete_from != kNoClass) gather_left_out(step, now);
  gather_half_spaces(step);
  part_pairs_.find(step, cache_, others_);
  if (!std::is_sorted(others_.begin(), others_.end())) std::sort(others_.begin(), others_.end());
  pairs_ = others_.empty() ? now.pairs : others_;  // the list of the broad phase is not copied
  if (!others_.empty() && !now.pairs.empty()) {
    merged_.resize(now.pairs.size() + others_.size());
    std::merge(now.pairs.begin(), now.pairs.end(), others_.begin(), others_.end(), merged_.begin());
    pairs_ = merged_;
  }
  sampler_.sample_pairs(step, pairs_);
}

void PairMatcher::gather_half_spaces(Step step) {
  due_.clear();
  world_.half_space_times.due(step, due_);
  if (due_.empty()) return;
  sampler_.sample(step, due_);
  for (const BodyIndex body : due_) {
    world_.half_space_times.update(world_.bodies[body], step, world_.clock,
                                   sampler_.given_motion(body, world_.clock.time(step)), world_.options.position_slack,
                                   others_);
  }
}

void PairMatcher::gather_left_out(Step step, const Advance& now) {
  auto reported = now.pairs.begin();
  for (std::size_t place = 0; place < cache_.size(); ++place) {
    const BodyPair& pair = cache_.pair(place);
    if (is_half_space(pair.b) || part_pairs_.finds(pair)) continue;
    while (reported != now.pairs.end() && *reported < pair) ++reported;
    if (reported != now.pairs.end() && *reported == pair) continue;
    if (world_.bodies.are_there(pair, cache_.known(place).generations)) others_.push_back(pair);
  }
  left_out_.clear();
  for (const BodyPair& pair : others_) left_out_.push_back(pair.a), left_out_.push_back(pair.b);
  sampler_.sample(step, left_out_);
  std::erase_if(others_, [&](const BodyPair& pair) {
    const double dt = world_.clock.time_step;
    const Motion a = world_.bodies[pair.a].motion(dt), b = world_.bodies[pair.b].motion(dt);
    return a.radius >= 0 && b.radius >= 0 && !spheres_touch(a, b);
  });
}

CachedPair& PairMatcher::cached(PairCache::Known& known) {
  CachedPair& pair = cache_[known.record];
  if (pair.a != kNoBody) return pair;
  pair.bodies = known.pair;
  const Body &a = world_.places.body(known.pair.a), &b = world_.places.body(known.pair.b);
  pair.a = a.id, pair.b = b.id;
  pair.versions.filters = filter_changes(a, b) - 1;
  pair.versions.jumps = a.changes.jumps + b.changes.jumps;
  pair.versions.deformed = a.changes.deformed + b.changes.deformed;
  if (is_half_space(known.pair.b) || !a.several.empty() || !b.several.empty()) return pair;
  const Shape &of_a = world_.shapes[a.one.shape], &of_b = world_.shapes[b.one.shape];
  pair.coherent = of_a.has_tree() && of_b.has_tree();
  if (pair.coherent) pair.trees = TreePair(of_a.prepared, of_b.prepared);
  return pair;
}

bool PairMatcher::allowed(CachedPair& pair) const {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  if (std::exchange(pair.versions.filters, filter_changes(a, b)) == filter_changes(a, b)) return pair.versions.allowed;
  pair.versions.allowed = filters_allow(a, b) && (!world_.filter || world_.filter(pair.a, pair.b));
  return pair.versions.allowed;
}

}  // namespace orchard::runtime::detail
