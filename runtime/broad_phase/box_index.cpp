#include "broad_phase/box_index.h"

namespace orchard::runtime::detail {
namespace {

static_assert((kMaxCellsPerAxis & (kMaxCellsPerAxis - 1)) == 0);

template <typename All>
void forget_oversized(All& all, BodyIndex body) noexcept {
  std::erase_if(all, [body](const auto& large) { return large.body == body; });
}

}  // namespace

void BoxIndex::rebuild(std::size_t slots, std::size_t lines) {
  std::fill(places_.begin(), places_.end(), Place::nowhere);
  oversized_.clear();
  extent_ = kNoBox;
  if (lines == 0) {
    grid_.release();
    give_back(boxes_);
  } else {
    grid_.begin_reset(lines);
    grow(boxes_, slots);
  }
}

// In the order of the timing wheel bodies are all over memory: their lines are loaded some bodies ahead.
void BoxIndex::take_away(std::span<const BodyIndex> bodies) noexcept {
  constexpr std::size_t kAtOnce = SweptGrid::Removals::kBodies;
  std::array<SweptGrid::Removals, 2> removals;  // of those at hand, and of the next ones
  const auto load = [&](std::size_t begin) {
    const std::size_t end = std::min(bodies.size(), begin + kAtOnce);
    for (std::size_t i = begin; i < end; ++i) {
      const BodyIndex body = bodies[i];
      if (i + kAtOnce < bodies.size()) prefetch(&boxes_[bodies[i + kAtOnce]]);
      if (places_[body] == Place::oversized) forget_oversized(oversized_, body);
      if (places_[body] == Place::inside)
        grid_.prepare_removal(body, boxes_[body].whole(), removals[begin / kAtOnce % 2]);
      places_[body] = Place::nowhere;
    }
  };
  load(0);
  for (std::size_t begin = 0; begin < bodies.size(); begin += kAtOnce) {
    load(begin + kAtOnce);
    grid_.remove(removals[begin / kAtOnce % 2]);
  }
}

void BoxIndex::note(std::span<const BodyIndex> bodies, const BoxBlock& boxes, QuantizedAabb& extent) noexcept {
  boxes.store(bodies, boxes_);
  for (const BodyIndex body : bodies) places_[body] = Place::inside;
  extent.include(boxes.around);
}

namespace {

void compare(BodyIndex body, const QuantizedAabb& box, BodyIndex other, const QuantizedAabb& with,
             std::vector<BodyPair>& pairs) {
  if (with.meets(box)) pairs.push_back({std::min(body, other), std::max(body, other)});
}

}  // namespace

// Bodies as large as several cells are compared with everything: (their number) x (the number of all) per window.
void BoxIndex::meet_oversized(std::span<const BodyIndex> bodies, std::vector<BodyPair>& pairs) const {
  if (oversized_.empty()) return;
  for (const BodyIndex body : bodies) {
    for (const Oversized& large : oversized_) compare(body, boxes_[body].whole(), large.body, large.box, pairs);
  }
}

void BoxIndex::insert_one(BodyIndex body, const QuantizedAabb& box, std::vector<BodyPair>& pairs, GridCounts& counts) {
  if (fits_grid(box)) {
    boxes_[body] = PackedAabb(box);
    places_[body] = Place::inside;
    extent_.include(box);
    BoxBlock block;
    block.set(0, box);
    SweptGrid::Batch batch;
    grid_.encode(batch, {&body, 1}, block, 0);
    grid_.insert(batch, boxes_, pairs, counts);
    ++counts.bodies;
    return meet_oversized({&body, 1}, pairs);
  }
  for (BodyIndex other = 0; other < places_.size(); ++other) {
    if (places_[other] == Place::inside) compare(body, box, other, boxes_[other].whole(), pairs);
  }
  for (const Oversized& large : oversized_) compare(body, box, large.body, large.box, pairs);
  places_[body] = Place::oversized;
  oversized_.push_back({body, box});
}

}  // namespace orchard::runtime::detail
