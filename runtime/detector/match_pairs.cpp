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
  due_motions_.clear();
  for (const BodyIndex body : due_) due_motions_.push_back(sampler_.given_motion(body, world_.clock.time(step)));
  world_.half_space_times.update_windows(step, world_.clock, due_, world_.bodies, due_motions_, world_.clock.time_step,
                                         world_.options.position_slack, pairs_.with_planes);
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
  std::erase_if(kept, [&](const BodyPair& pair) { return world_.bodies.surely_apart(pair, world_.clock.time_step); });
}

CachedPair& PairMatcher::cached(PairCache::Known& known) {
  if (cache_.is_begun(known)) return cache_[known.record];
  CachedPair& pair = cache_.begin(known);
  pair.bodies = known.pair;
  const Body &a = world_.places.body(known.pair.a), &b = world_.places.body(known.pair.b);
  pair.a = a.id, pair.b = b.id;
  pair.versions.pair_filter = world_.filter_version - 1;
  pair.versions.jumps = a.jumps + b.jumps;
  pair.versions.deformed = a.deformed + b.deformed;
  if (!a.one || !b.one) return pair;
  const Shape &of_a = world_.shapes[a.shape], &of_b = world_.shapes[b.shape];
  pair.coherent = of_a.has_tree() && of_b.has_tree();
  if (pair.coherent) pair.trees = TreePair(of_a.prepared, of_b.prepared);
  return pair;
}

bool PairMatcher::allowed(CachedPair& pair) const {
  const Body &a = world_.places.body(pair.bodies.a), &b = world_.places.body(pair.bodies.b);
  if (pair.versions.pair_filter == world_.filter_version && pair.versions.filter_a == a.filters &&
      pair.versions.filter_b == b.filters) {
    return pair.versions.allowed;
  }
  pair.versions.pair_filter = world_.filter_version;
  pair.versions.filter_a = a.filters, pair.versions.filter_b = b.filters;
  pair.versions.allowed = filters_allow(a, b) && (!world_.filter || world_.filter(pair.a, pair.b));
  return pair.versions.allowed;
}

}  // namespace orchard::runtime::detail
