#include "detector/search_by_parts.h"

#include <algorithm>

namespace orchard::runtime::detail {

namespace {

// Static bodies in the sphere around all parts, for each part. What keeping a pair of such spheres costs a step in the
// broad phase and after it is a thirtieth or so of what a part costs here, where it is crowded.
constexpr std::size_t kWorthIt = 40, kNoLonger = 20;
constexpr Step kSteps = 16;  // from one choice to the next

bool is_with_static(const BodyTable& bodies, const BodyPair& pair) noexcept {
  return (bodies[pair.a].by_parts && bodies[pair.b].is_static) || (bodies[pair.b].by_parts && bodies[pair.a].is_static);
}

}  // namespace

bool PartPairs::finds(const BodyPair& pair) const noexcept {
  return any() && !is_half_space(pair.b) && is_with_static(world_.bodies, pair);
}

// The static bodies whose spheres touch one of these, in ascending order. Until the next call.
std::span<const BodyIndex> PartPairs::touching(std::span<const FloatSphere> spheres) {
  spheres_.prepare();
  touching_.clear();
  for (const FloatSphere& sphere : spheres) spheres_.append_touching(sphere, touching_);
  std::sort(touching_.begin(), touching_.end());
  touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
  return touching_;
}

void PartPairs::static_changed(BodyIndex body) {
  if (any()) spheres_.put(body, world_.bodies.float_part_spheres(body));
}

// A body whose state is not valid may be where it was.
void PartPairs::keep_pairs_of(BodyIndex body, const PairCache& before, std::vector<BodyPair>& found) const {
  for (std::size_t place = 0; place < before.size(); ++place) {
    const BodyPair& pair = before.pair(place);
    if ((pair.a == body || pair.b == body) && finds(pair) &&
        world_.bodies.are_there(pair, before.known(place).generations))
      found.push_back(pair);
  }
}

void PartPairs::find(Step step, const PairCache& before, std::vector<BodyPair>& found) {
  if (!any()) return;
  sampler_.sample(step, bodies_);
  for (const BodyIndex body : bodies_) {
    if (world_.bodies[body].valid) {
      for (const BodyIndex other : touching(world_.bodies.float_part_spheres(body)))
        found.push_back({std::min(body, other), std::max(body, other)});
    } else {
      sampler_.refuse({&body, 1});
      keep_pairs_of(body, before, found);
    }
  }
  if (!std::is_sorted(found.begin(), found.end())) std::sort(found.begin(), found.end());
  if (!world_.any.own_filter && !world_.filter) return;
  std::erase_if(found, [this](const BodyPair& pair) { return world_.filters_exclude(pair); });
}

BodyFilter PartPairs::broad_filter(const Body& body) noexcept {
  BodyFilter filter = body.filter();
  filter.ignores_static = filter.ignores_static || body.by_parts;
  return filter;
}

void PartPairs::search(BodyIndex index, bool wanted) {
  Body& body = world_.bodies[index];
  body.by_parts = wanted;
  const bool begins = !any();
  if (wanted) bodies_.insert(std::lower_bound(bodies_.begin(), bodies_.end(), index), index);
  for (BodyIndex i = 0; begins && i < world_.bodies.slots(); ++i) {
    if (world_.bodies[i].id != kNoBody && world_.bodies[i].is_static) static_changed(i);
  }
  if (!wanted) end(index);
  broad_.set_filter(body.id, broad_filter(body));
}

void PartPairs::choose(Step step, const PairCache& pairs) {
  const BodyTable& bodies = world_.bodies;
  if (!bodies.any_parts() || !world_.any.static_body || world_.any.continuous || step < choose_at_) return;
  choose_at_ = step + kSteps;
  to_change_.clear();
  for (const BodyIndex index : bodies_) {
    const Body& body = bodies[index];
    const FloatSphere around = bodies.sphere_around(index);
    if (body.valid && touching({&around, 1}).size() < kNoLonger * body.parts.size()) to_change_.push_back(index);
  }
  static_pairs_.assign(bodies.slots(), 0);
  for (std::size_t place = 0; place < pairs.size(); ++place) {
    const BodyPair& pair = pairs.pair(place);
    if (is_half_space(pair.b) || bodies[pair.a].is_static == bodies[pair.b].is_static) continue;
    const BodyIndex moving = bodies[pair.a].is_static ? pair.b : pair.a;
    const Body& body = bodies[moving];
    if (!body.by_parts && ++static_pairs_[moving] == kWorthIt * body.parts.size() && !body.one && body.id != kNoBody)
      to_change_.push_back(moving);
  }
  for (const BodyIndex body : to_change_) search(body, !bodies[body].by_parts);
}

void PartPairs::end(BodyIndex body) noexcept {
  std::erase(bodies_, body);
  if (!any()) spheres_ = {};
}

void PartPairs::choose_none() {
  while (any()) search(bodies_.front(), false);
}

void PartPairs::gone(const Body& body) noexcept {
  if (body.by_parts) end(body.id.index);
  if (body.is_static && any()) spheres_.take_away(body.id.index);
}

std::size_t PartPairs::memory_bytes() const noexcept {
  return bytes_of(bodies_, touching_) + spheres_.memory_bytes() + bytes_of(static_pairs_, to_change_);
}

}  // namespace orchard::runtime::detail
