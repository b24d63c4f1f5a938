#include <algorithm>

#include "detector/detector_state.h"

// Pairs with static bodies that are found by parts; see PartSearch.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;

namespace {

// Static bodies in the sphere around all parts, for each part. What keeping a pair of such spheres costs a step in the
// broad phase and after it is a thirtieth or so of what a part costs here, where it is crowded.
constexpr std::size_t kWorthIt = 40, kNoLonger = 20;
constexpr detail::Step kSteps = 16;  // from one choice to the next

bool is_with_static(const detail::BodyTable& bodies, const BodyPair& pair) noexcept {
  return (bodies[pair.a].by_parts && bodies[pair.b].is_static) || (bodies[pair.b].by_parts && bodies[pair.a].is_static);
}

}  // namespace

// Those of the broad phase that are none of its business any more.
bool Detector::State::found_by_parts(const BodyPair& pair) const noexcept {
  return part_search.any() && !is_half_space(pair.b) && is_with_static(bodies, pair);
}

// Where an invalid one is nobody knows: it may be where it was.
void Detector::State::keep_part_pairs(BodyIndex body) {
  for (std::size_t place = 0; place < records.size(); ++place) {
    const BodyPair& pair = records.pair(place);
    if ((pair.a == body || pair.b == body) && found_by_parts(pair) && still_there(records.known(place)))
      pairs.by_parts.push_back(pair);
  }
}

void Detector::State::find_part_pairs(Step step) {
  if (!part_search.any()) return;
  bodies.ask(step, clock.time(step), part_search.bodies(), options.executor);
  for (const BodyIndex body : part_search.bodies()) {
    if (bodies[body].valid) {
      for (const BodyIndex other : part_search.touching(body, bodies))
        pairs.by_parts.push_back({std::min(body, other), std::max(body, other)});
    } else {
      refused.push_back(body);
      keep_part_pairs(body);
    }
  }
  if (!std::is_sorted(pairs.by_parts.begin(), pairs.by_parts.end()))
    std::sort(pairs.by_parts.begin(), pairs.by_parts.end());
  if (!filters_pairs && !filter) return;
  std::erase_if(pairs.by_parts, [this](const BodyPair& pair) {
    const Body &a = bodies[pair.a], &b = bodies[pair.b];
    return !detail::filters_allow(a, b) || (filter && !filter(a.id, b.id));
  });
}

void Detector::State::search_by_parts(BodyIndex index, bool wanted) {
  Body& body = bodies[index];
  body.by_parts = wanted;
  if (wanted) {
    part_search.begin(index, bodies);
  } else {
    part_search.end(index);
  }
  broad.set_filter(body.id, broad_filter(body));
}

// For the steps after this one.
void Detector::State::choose_part_searches(Step step) {
  if (!bodies.any_parts() || !any_static || any_continuous || step < choose_parts_at) return;
  choose_parts_at = step + kSteps;
  searches_to_change.clear();
  for (const BodyIndex index : part_search.bodies()) {
    const Body& body = bodies[index];
    if (body.valid && part_search.count_touching(bodies.sphere_around(index)) < kNoLonger * body.parts.size())
      searches_to_change.push_back(index);
  }
  static_pairs.assign(bodies.slots(), 0);
  for (std::size_t place = 0; place < records.size(); ++place) {
    const BodyPair& pair = records.pair(place);
    if (is_half_space(pair.b) || bodies[pair.a].is_static == bodies[pair.b].is_static) continue;
    const BodyIndex moving = bodies[pair.a].is_static ? pair.b : pair.a;
    const Body& body = bodies[moving];
    if (!body.by_parts && ++static_pairs[moving] == kWorthIt * body.parts.size() && !body.one && body.id != kNoBody)
      searches_to_change.push_back(moving);
  }
  for (const BodyIndex body : searches_to_change) search_by_parts(body, !bodies[body].by_parts);
}

}  // namespace orchard::runtime
