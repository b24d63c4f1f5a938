#include "broad_phase/window_updates.h"

#include <bit>

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kNearAtOnce = 512;  // near pairs that are tested together

// By a quarter at most, along each axis.
bool hardly_longer(const QuantizedAabb& box, const QuantizedAabb& than) noexcept {
  const auto length = [](const QuantizedAabb& of, std::size_t d) { return std::uint64_t{of.upper[d]} - of.lower[d]; };
  for (std::size_t d = 0; d < 3; ++d) {
    if (4 * length(box, d) > 5 * length(than, d)) return false;
  }
  return true;
}

}  // namespace

// True if all windows end at the same step.
bool WindowUpdates::set_ends(Block& block, std::span<const BodyIndex> bodies,
                             std::span<const Motion> motions) const noexcept {
  const Windows& windows = parts_.windows;
  const auto duration = [&](Step end) {
    return end == kNeverStep ? 0 : parts_.pool.clock.seconds_between(block.now, end - 1);
  };
  const Step planned = windows.end_of(block.from, motions[0], block.last);
  const Step common = windows.end_of(block.from, bodies[0], motions[0], block.last);
  std::uint64_t other = 0;  // bits of expiries that differ
  for (const Motion& motion : motions) {
    other |= std::bit_cast<std::uint64_t>(motion.expiry) ^ std::bit_cast<std::uint64_t>(motions[0].expiry);
  }
  const bool alike = other == 0 && std::isfinite(motions[0].expiry);
  if (alike && !parts_.pool.any_static() && !windows.any_short()) {
    if (block.common != common) {
      block.common = common;
      block.ends.fill(common);
      block.durations.fill(duration(common));
    }
    return true;
  }
  block.common = kUpdateDue;
  // Whether one may rest and another not, or some may rest as long as they are cancelled again and again.
  const bool may_rest = windows.may_never_end() && motions[0].expiry == std::numeric_limits<double>::infinity();
  bool same = !parts_.pool.any_static() && !(may_rest && windows.any_short());
  for (std::size_t i = 0; may_rest && same && i < bodies.size(); ++i) same = rests(motions[i]) == rests(motions[0]);
  for (std::size_t i = 0; i < bodies.size(); ++i) same = same && motions[i].expiry == motions[0].expiry;
  for (std::size_t i = 0; windows.any_short() && same && i < bodies.size(); ++i) {
    same = std::min(planned, block.from + windows[bodies[i]].lasting) == common;
  }
  block.ends.fill(common);
  block.durations.fill(duration(common));
  for (std::size_t i = 0; !same && i < bodies.size(); ++i) {
    block.ends[i] = windows.end_of(block.from, bodies[i], motions[i], block.last);
    block.durations[i] = duration(block.ends[i]);
  }
  return same;
}

// Boxes until the ends of the windows; false if a motion is not valid.
bool WindowUpdates::make_boxes(Block& block, std::span<const Motion> motions, bool same_ends) const noexcept {
  const auto no_expiry = [](const Motion& motion) { return std::isnan(motion.expiry); };
  bool valid = same_ends || std::none_of(motions.begin(), motions.end(), no_expiry);
  const auto durations = std::span(block.durations).first(motions.size());
  valid = block.quantized_grid.boxes(motions, durations, block.boxes) && valid;
  const auto is_one = [](const Motion& motion) { return is_valid(motion); };
  return valid || std::all_of(motions.begin(), motions.end(), is_one);
}

// Makes the boxes of a block of bodies, until the ends of their windows. Does nothing and returns false if a motion is
// not valid.
bool WindowUpdates::place(Block& block, std::span<const BodyIndex> bodies) {
  const auto motions = std::span(std::as_const(motions_)).first(bodies.size());
  bool same = set_ends(block, bodies, motions);
  if (!make_boxes(block, motions, same)) return false;

  if (same && block.ends[0] != kNeverStep) {
    parts_.windows.set_alike(bodies, block.from, block.ends[0]);
  } else {
    parts_.windows.set(bodies, block.from, std::span(block.ends).first(bodies.size()));
  }
  parts_.overlaps.mark_updated(bodies);
  const bool notes_spheres = parts_.pairs.notes_spheres();
  for (std::size_t i = 0; notes_spheres && i < bodies.size(); ++i) {
    parts_.pairs.note_sphere(bodies[i], motions[i], block.quantized_grid, block.durations[i]);
  }
  parts_.planner.note(motions);
  same = note_boxes(block, bodies) && same;
  if (same) {
    if (block.ends[0] != kNeverStep) parts_.wheel.set_due(bodies, block.ends[0]);
    parts_.windows.vote(block.ends[0], bodies.size());
    return true;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Step end = parts_.windows[bodies[i]].end;
    if (end != kNeverStep) parts_.wheel.set_due(bodies.subspan(i, 1), end);
    parts_.windows.vote(end, 1);
  }
  return true;
}

// False if a window had to be cut short.
bool WindowUpdates::note_boxes(Block& block, std::span<const BodyIndex> bodies) {
  if (parts_.boxes.note(bodies, block.boxes)) return true;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!parts_.boxes.fits(bodies[i])) shrink(block, bodies[i], i);
  }
  return false;
}

// Faster than the others: update it again sooner, until its box takes few enough cells. One that is too large for that
// is not updated sooner than its motion is worth.
void WindowUpdates::shrink(Block& block, BodyIndex body, std::size_t i) {
  Window& window = parts_.windows[body];
  Step steps = window.end == kNeverStep ? 1 : window.end - block.from;
  if (steps <= 1) return;
  const auto box_for = [&](Step wanted) {
    const double duration = parts_.pool.clock.seconds_between(block.now, block.from + wanted - 1);
    BoxBlock box;
    block.quantized_grid.boxes({&motions_[i], 1}, {&duration, 1}, box);
    return box.get(0);
  };
  const QuantizedAabb least = box_for(1);
  const bool large = !BoxIndex::fits(least);
  QuantizedAabb box = block.boxes.get(i);
  while (steps > 1 && !(large ? hardly_longer(box, least) : BoxIndex::fits(box))) {
    steps = (steps + 1) / 2;
    box = box_for(steps);
  }
  window.end = block.from + steps;
  window.length = static_cast<std::uint8_t>(steps);
  parts_.boxes.note_again(body, box);
  block.boxes.set(i, box);
}

// Moves those whose new bounds are known up to `from`, with their motions, to the front; returns how many.
std::size_t WindowUpdates::known_at(Step from, std::span<BodyIndex> bodies, std::span<Motion> motions) const noexcept {
  std::size_t front = 0;
  double known = std::numeric_limits<double>::infinity();  // an expiry that is late enough
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double expiry = motions[i].expiry;
    if (expiry != known && !parts_.pool.is_static(bodies[i])) {
      if (parts_.pool.clock.last_before_expiry(expiry) < from) continue;
      known = expiry;
    }
    if (front < i) {
      std::swap(bodies[front], bodies[i]);
      motions[front] = motions[i];
    }
    ++front;
  }
  return front;
}

bool WindowUpdates::know_mostly(Step now, Step from, std::span<BodyIndex> bodies) {
  make_room_for_motions(bodies.size());
  parts_.pool.ask(now, bodies, std::span(motions_).first(bodies.size()));
  return 2 * known_at(from, bodies, motions_) >= bodies.size();
}

// Moves those whose motions are valid, with these, to the front; returns how many.
std::size_t WindowUpdates::refuse_invalid(std::span<BodyIndex> bodies) {
  std::size_t front = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_valid(motions_[i])) {
      parts_.refusals.refuse(bodies[i]);
      continue;
    }
    if (front < i) {
      bodies[front] = bodies[i];
      motions_[front] = motions_[i];
    }
    ++front;
  }
  return front;
}

std::span<const Motion> WindowUpdates::ask_valid(Step now, std::span<BodyIndex>& bodies) {
  make_room_for_motions(bodies.size());
  parts_.pool.ask(now, bodies, std::span(motions_).first(bodies.size()));
  bodies = bodies.first(refuse_invalid(bodies));
  return std::span(motions_).first(bodies.size());
}

void WindowUpdates::find(Step now, Step from, std::span<const BodyIndex> bodies, bool tested) {
  const std::size_t at_once = std::min(kBlock, bodies.size());
  make_room_for_motions(at_once);
  near_.clear();
  Block update;
  update.now = now;
  update.from = from;
  update.quantized_grid = parts_.boxes.quantized_grid_at(now);
  BoxIndex::Queue queue;
  std::array<BodyIndex, kBlock> known;
  for (std::size_t done = 0; done < bodies.size();) {
    auto block = bodies.subspan(done, std::min(at_once, bodies.size() - done));
    parts_.pool.ask(now, block, std::span(motions_).first(block.size()));
    done += block.size();
    if (from > now) {
      std::copy(block.begin(), block.end(), known.begin());
      const std::size_t front = known_at(from, std::span(known).first(block.size()), motions_);
      for (std::size_t i = front; i < block.size(); ++i) parts_.changes.note(known[i]);
      block = std::span(known).first(front);
      if (block.empty()) continue;
    }
    if (!place(update, block)) {
      if (block.data() != known.data()) std::copy(block.begin(), block.end(), known.begin());
      block = std::span(known).first(refuse_invalid(std::span(known).first(block.size())));
      if (block.empty()) continue;
      place(update, block);
    }
    parts_.boxes.insert(queue, block, update.boxes, near_);
    if (tested && near_.size() >= kNearAtOnce) {
      parts_.boxes.finish(queue, near_);
      test_near(now);
    }
  }
  parts_.boxes.finish(queue, near_);
}

void WindowUpdates::test_near(Step now) {
  if (parts_.pool.filters_pairs()) drop_what_is_none();
  parts_.pairs.test_near(now, near_);
  near_.clear();
}

void WindowUpdates::update(Step now, Step from, std::span<const BodyIndex> bodies) {
  find(now, from, bodies, true);
  test_near(now);
}

std::span<const BodyPair> WindowUpdates::find_near(Step now, std::span<const BodyIndex> bodies) {
  find(now, now, bodies, false);
  if (parts_.pool.filters_pairs()) drop_what_is_none();
  return near_;
}

// Pairs that the filters exclude. The plan does not count them: they cost next to nothing.
void WindowUpdates::drop_what_is_none() {
  const BodyPool& pool = parts_.pool;
  parts_.boxes.discount_pairs(std::erase_if(near_, [&](const BodyPair& pair) { return !pool.may_pair(pair); }));
}

}  // namespace orchard::runtime::detail
