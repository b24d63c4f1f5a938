#include "broad_phase/box_index.h"

namespace orchard::runtime::detail {
void BoxIndex::rebuild(std::size_t slots, std::size_t lines, const Executor& executor) {
  std::fill(places_.begin(), places_.end(), Place::nowhere);
  oversized_.clear();
  extent_ = kNoBox;
  if (lines == 0) {
    grid_.release();
    give_back(boxes_);
  } else {
    grid_.reset(lines, executor);
    grow(boxes_, slots);
  }
}

// The bodies come in the order of the timing wheel and are scattered in memory, so their boxes are loaded some bodies
// ahead.
void BoxIndex::take_away(std::span<const BodyIndex> bodies) noexcept {
  constexpr std::size_t kAtOnce = SweptGrid::kRemovedAtOnce;
  std::array<BodyIndex, kAtOnce> inside;
  for (; !bodies.empty(); bodies = bodies.subspan(std::min(kAtOnce, bodies.size()))) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(kAtOnce, bodies.size()); ++i) {
      if (i + kAtOnce < bodies.size()) prefetch(&boxes_[bodies[i + kAtOnce]]), prefetch(&places_[bodies[i + kAtOnce]]);
      const BodyIndex body = bodies[i];
      const Place place = std::exchange(places_[body], Place::nowhere);
      if (place == Place::oversized) std::erase_if(oversized_, [=](const Oversized& o) { return o.body == body; });
      inside[count] = body;
      count += place == Place::inside ? 1 : 0;
    }
    grid_.remove(std::span(inside).first(count), boxes_);
  }
}

void BoxIndex::note(std::span<const BodyIndex> bodies, const BoxBlock& boxes, QuantizedAabb& extent) noexcept {
  boxes.store(bodies, boxes_);
  Place* const places = places_.data();  // a copy, because what is written might be the vector
  for (const BodyIndex body : bodies) places[body] = Place::inside;
  extent.include(boxes.around);
}

namespace {

void compare(BodyIndex body, const QuantizedAabb& box, BodyIndex other, const QuantizedAabb& with,
             std::vector<BodyPair>& pairs) {
  if (with.meets(box)) pairs.push_back({std::min(body, other), std::max(body, other)});
}

}  // namespace

// Oversized boxes are compared with all others, which costs O(oversized x all) per window.
void BoxIndex::meet_oversized(std::span<const BodyIndex> bodies, std::vector<BodyPair>& pairs) const {
  if (oversized_.empty()) return;
  for (const BodyIndex body : bodies) {
    for (const Oversized& large : oversized_) compare(body, boxes_[body].whole(), large.body, large.box, pairs);
  }
}

void BoxIndex::insert_one(BodyIndex body, const QuantizedAabb& box, SweptGrid::Visits& room,
                          std::vector<BodyPair>& pairs, GridCounts& counts) {
  if (fits_grid(box)) {
    BoxBlock block;
    block.set(0, box);
    block.around = box;
    note({&body, 1}, block, extent_);
    room.clear();
    grid_.encode({&body, 1}, block, room);
    grid_.insert(room.visits(), boxes_, pairs, counts);
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
