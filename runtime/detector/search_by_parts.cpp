#include "detector/search_by_parts.h"

#include <algorithm>
#include <bit>

#include "simd/machine.h"

namespace orchard::runtime::detail {

namespace {

// The numbers of static bodies in the sphere around all parts, for each part, from which on and down to which a body is
// searched by parts. To keep a pair of such spheres costs a step, in the broad phase and after it, about a thirtieth of
// what a part costs here in a crowded place.
constexpr std::size_t kWorthIt = 40, kNoLonger = 20;
constexpr Step kSteps = 16;  // from one choice of bodies to the next

constexpr std::size_t kLanes = 32;  // spheres in a leaf, which are compared at once
constexpr auto kLaneBits = [] {
  std::array<std::uint64_t, kLanes + 1> bits{};
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = std::uint64_t{1} << i;
  return bits;
}();

// Returns which lanes of `at`, which has the x, y, z and radii of spheres, touch a sphere, as bits. The loop has no
// branches, so that it becomes comparisons of vectors.
std::uint64_t touching_lanes(const std::array<const double*, 4>& at, const Vec3& center, double radius) noexcept {
  std::uint64_t bits = 0;
  per_machine([&]() ORCHARD_INLINE_LAMBDA {
    std::uint64_t found = 0;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const double x = at[0][i] - center[0], y = at[1][i] - center[1], z = at[2][i] - center[2];
      const double reach = at[3][i] + radius;
      found |= x * x + y * y + z * z <= reach * reach ? kLaneBits[i] : 0;
    }
    bits = found;
  });
  return bits;
}

}  // namespace

bool PartPairs::finds(const BodyPair& pair) const noexcept {
  if (!any() || is_half_space(pair.b)) return false;
  const Body &a = world_.bodies[pair.a], &b = world_.bodies[pair.b];
  return (a.by_parts && b.is_static) || (b.by_parts && a.is_static);
}

void PartPairs::place_static() {
  if (static_changes_ == world_.static_changes) return;
  spheres_.clear();
  for (BodyIndex i = 0; i < world_.bodies.slots(); ++i) {
    if (world_.bodies[i].id == kNoBody || !world_.bodies[i].is_static) continue;
    for (std::uint32_t k = 0; k < world_.places.parts(i); ++k) spheres_.add(world_.places.sphere(i, k), i, k);
  }
  spheres_.build(kLanes);
  const auto parts = spheres_.parts();
  for (std::size_t d = 0; d < 4; ++d) {
    lanes_[d].assign(parts.size() + kLanes, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < parts.size(); ++i) lanes_[d][i] = d < 3 ? parts[i].center[d] : parts[i].reach;
  }
  static_changes_ = world_.static_changes;
}

// Appends to touching_ the static bodies with a part whose sphere touches this one. A body may occur once for each
// part.
void PartPairs::append_touching(const BoundingSphere& sphere) {
  const Vec3& center = sphere.center;
  const double most = sphere.reach * (1 + 1e-9);
  const auto append_leaf = [&](std::uint32_t begin, std::uint32_t end) {
    const std::array<const double*, 4> at = {&lanes_[0][begin], &lanes_[1][begin], &lanes_[2][begin],
                                             &lanes_[3][begin]};
    std::uint64_t touching = touching_lanes(at, center, most) & (kLaneBits[end - begin] - 1);
    for (; touching != 0; touching &= touching - 1)
      touching_.push_back(spheres_.parts()[begin + static_cast<std::size_t>(std::countr_zero(touching))].body);
  };
  spheres_.walk([&](const Vec3& low, const Vec3& high) { return square_to_box(low, high, center); },
                [&] { return most * most; }, append_leaf);
}

void PartPairs::find(Step step, const PairCache& before, std::vector<BodyPair>& found) {
  if (!any()) return;
  place_static();
  sampler_.sample(step, bodies_);
  for (const BodyIndex body : bodies_) {
    touching_.clear();
    if (world_.bodies[body].valid) {
      for (std::uint32_t k = 0; k < world_.places.parts(body); ++k) append_touching(world_.places.sphere(body, k));
      std::sort(touching_.begin(), touching_.end());
      touching_.erase(std::unique(touching_.begin(), touching_.end()), touching_.end());
      for (const BodyIndex other : touching_) found.push_back({std::min(body, other), std::max(body, other)});
      continue;
    }
    sampler_.refuse({&body, 1});  // it may still be where it was
    for (std::size_t place = 0; place < before.size(); ++place) {
      const BodyPair& pair = before.pair(place);
      if ((pair.a == body || pair.b == body) && finds(pair) &&
          world_.bodies.are_there(pair, before.known(place).generations))
        found.push_back(pair);
    }
  }
  if (!world_.any.own_filter && !world_.filter) return;
  std::erase_if(found, [this](const BodyPair& pair) { return finds(pair) && world_.filters_exclude(pair); });
}

BodyFilter PartPairs::broad_filter(const Body& body) noexcept {
  BodyFilter filter = body.options.filter;
  filter.ignores_static = filter.ignores_static || body.by_parts;
  return filter;
}

void PartPairs::search(BodyIndex index, bool wanted) {
  Body& body = world_.bodies[index];
  if (wanted) bodies_.insert(std::lower_bound(bodies_.begin(), bodies_.end(), index), index);
  if (!wanted) gone(body);
  body.by_parts = wanted;
  broad_.set_filter(body.id, broad_filter(body));
}

void PartPairs::choose(Step step, const PairCache& pairs) {
  const BodyTable& bodies = world_.bodies;
  if (!world_.any.parts || !world_.any.static_body || world_.any.continuous || step < choose_at_) return;
  choose_at_ = step + kSteps;
  to_change_.clear();
  if (any()) place_static();
  for (const BodyIndex index : bodies_) {
    touching_.clear();
    append_touching(bodies[index].sphere());
    if (bodies[index].valid && touching_.size() < kNoLonger * bodies[index].parts().size()) to_change_.push_back(index);
  }
  static_pairs_.assign(bodies.slots(), 0);
  for (std::size_t place = 0; place < pairs.size(); ++place) {
    const BodyPair& pair = pairs.pair(place);
    if (is_half_space(pair.b) || bodies[pair.a].is_static == bodies[pair.b].is_static) continue;
    const BodyIndex moving = bodies[pair.a].is_static ? pair.b : pair.a;
    const Body& body = bodies[moving];
    if (!body.by_parts && ++static_pairs_[moving] == kWorthIt * body.parts().size() && !body.several.empty() &&
        body.id != kNoBody)
      to_change_.push_back(moving);
  }
  for (const BodyIndex body : to_change_) search(body, !bodies[body].by_parts);
}

void PartPairs::choose_none() {
  while (any()) search(bodies_.front(), false);
}

void PartPairs::gone(const Body& body) noexcept {
  if (!body.by_parts) return;
  std::erase(bodies_, body.id.index);
  if (!any()) spheres_ = {}, lanes_ = {}, static_changes_ = 0;
}

}  // namespace orchard::runtime::detail
