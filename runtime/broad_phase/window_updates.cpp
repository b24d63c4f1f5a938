#include <bit>

#include "broad_phase/window_updates.h"

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kNearAtOnce = 512;  // near pairs that are tested together

}  // namespace

std::span<Motion> WindowUpdates::ask(Step now, std::span<const BodyIndex> bodies) {
  if (motions_.size() < bodies.size()) motions_.resize(bodies.size());
  const auto motions = std::span(motions_).first(bodies.size());
  state_.pool.motions.ask(now, bodies, motions);
  return motions;
}

// Moves the bodies whose motion bounds hold up to `from`, with their motions, to the front. Returns their number.
std::size_t WindowUpdates::known_at(Step from, std::span<BodyIndex> bodies, std::span<Motion> motions) const noexcept {
  std::size_t front = 0;
  double known = std::numeric_limits<double>::infinity();  // an expiry that is late enough
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double expiry = motions[i].expiry;
    if (expiry != known && !state_.pool.statics.has(bodies[i])) {
      if (state_.pool.clock.last_before_expiry(expiry) < from) continue;
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
  return 2 * known_at(from, bodies, ask(now, bodies)) >= bodies.size();
}

std::span<const Motion> WindowUpdates::ask_valid(Step now, std::span<BodyIndex>& bodies) {
  const std::span<Motion> motions = ask(now, bodies);
  std::size_t front = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_valid(motions[i])) {
      state_.refuse(bodies[i]);
      continue;
    }
    if (front < i) bodies[front] = bodies[i], motions[front] = motions[i];
    ++front;
  }
  bodies = bodies.first(front);
  return motions.first(front);
}

WindowUpdates::Block WindowUpdates::block_at(Step now, Step from) const noexcept {
  Block block;
  block.now = now;
  block.from = from;
  block.quantized_grid = state_.grid.at(now);
  return block;
}

// Sets the ends and the durations of the windows. Returns false if an expiry is NaN.
bool WindowUpdates::set_ends(Block& block, std::span<const BodyIndex> bodies,
                             std::span<const Motion> motions) const noexcept {
  std::uint64_t other = 0;  // the bits in which expiries differ
  for (const Motion& motion : motions) {
    other |= std::bit_cast<std::uint64_t>(motion.expiry) ^ std::bit_cast<std::uint64_t>(motions[0].expiry);
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const bool any_static = state_.pool.statics.any();
  const bool alike = other == 0 && !any_static &&
                     (std::isfinite(motions[0].expiry) || std::none_of(motions.begin(), motions.end(), rests));
  if (alike && motions[0].expiry == block.expiry) return true;
  block.expiry = alike ? motions[0].expiry : kNone;
  double known = kNone, duration = 0;  // the expiry that `end` and `duration` are for
  Step end = 0;
  bool all = true;
  for (std::size_t i = 0; i < (alike ? 1 : bodies.size()); ++i) {
    const double expiry = motions[i].expiry;
    const bool special = any_static || rests(motions[i]);  // the window may have no end
    if (special || expiry != known) {
      end = state_.windows.end_of(block.from, bodies[i], motions[i]);
      duration = end == kNeverStep ? 0 : state_.pool.clock.seconds_between(block.now, end - 1);
      known = special ? kNone : expiry;
      all = all && !std::isnan(expiry);
    }
    block.ends[i] = end, block.durations[i] = duration;
  }
  if (alike) block.ends.fill(block.ends[0]), block.durations.fill(block.durations[0]);
  return all;
}

// Makes the boxes of bodies until the ends of their windows. Returns false if a motion is not valid.
bool WindowUpdates::make_boxes(Block& block, std::span<const BodyIndex> bodies,
                               std::span<const Motion> motions) const noexcept {
  const bool timed = set_ends(block, bodies, motions);
  const auto durations = std::span(block.durations).first(motions.size());
  const bool valid = block.quantized_grid.boxes(motions, durations, block.boxes) && timed;
  const auto is_one = [](const Motion& motion) { return is_valid(motion); };
  return valid || std::all_of(motions.begin(), motions.end(), is_one);
}

// Places the bodies of a block that can be placed now. The others are added to chunk.left.
void WindowUpdates::place(Chunk& chunk, Block& block, std::span<BodyIndex> bodies, std::span<Motion> motions) const {
  std::size_t count = bodies.size();
  const auto leave_unless = [&](const auto& good) {
    std::size_t front = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!good(i)) {
        chunk.left.push_back({bodies[i], motions[i]});
        continue;
      }
      bodies[front] = bodies[i];
      motions[front++] = motions[i];
    }
    count = front;
  };
  for (bool fit = false; !fit && count > 0;) {
    const bool valid = make_boxes(block, bodies.first(count), motions.first(count));
    fit = valid && all_fit_grid(block.boxes);
    if (!valid) {
      leave_unless([&](std::size_t i) { return is_valid(motions[i]); });
    } else if (!fit) {
      leave_unless([&](std::size_t i) { return fits_grid(block.boxes.get(i)); });
    }
  }
  if (count == 0) return;
  bodies = bodies.first(count);
  state_.boxes.note(bodies, block.boxes, chunk.extent);
  SweptGrid::Visits& visits = block.by_part ? chunk.block_visits : chunk.visits[0];
  if (block.by_part) visits.clear();
  state_.boxes.lines().encode(bodies, block.boxes, visits);
  if (block.by_part) state_.boxes.lines().split(visits, chunk.visits);
  for (std::size_t i = 0; i < count; ++i) state_.windows.set(bodies[i], block.ends[i]);
  for (std::size_t i = 0; pairs_.spheres().any() && i < count; ++i) {
    pairs_.spheres().note(bodies[i], motions[i], block.quantized_grid, block.durations[i]);
  }
  chunk.placed.insert(chunk.placed.end(), bodies.begin(), bodies.end());
}

void WindowUpdates::place_chunk(Chunk& chunk, Block& block, std::span<const BodyIndex> bodies) const {
  chunk.clear();
  std::array<BodyIndex, kBlock> ids;
  const std::size_t at_once = std::min(kBlock, bodies.size());
  if (chunk.motions.size() < at_once) chunk.motions.resize(at_once);
  for (std::size_t done = 0; done < bodies.size(); done += kBlock) {
    const auto some = bodies.subspan(done, std::min(kBlock, bodies.size() - done));
    auto known = std::span(ids).first(some.size());
    const auto motions = std::span(chunk.motions).first(some.size());
    std::copy(some.begin(), some.end(), known.begin());
    state_.pool.motions.ask(block.now, known, motions, chunk.answers);
    chunk.asked += some.size();
    if (block.from > block.now) {
      const std::size_t front = known_at(block.from, known, motions);
      chunk.unknown.insert(chunk.unknown.end(), known.begin() + static_cast<std::ptrdiff_t>(front), known.end());
      known = known.first(front);
    }
    place(chunk, block, known, motions.first(known.size()));
  }
}

// Applies what place_chunk() has found to the state that all chunks share. Only one thread may do that.
void WindowUpdates::fold(Chunk& chunk) {
  std::span<const BodyIndex> placed = chunk.placed;
  state_.overlaps.mark_updated(placed);
  state_.boxes.meet_oversized(placed, near_);
  while (!placed.empty()) {  // successive bodies whose windows end together
    const Window first = state_.windows[placed[0]];
    const auto other = [&](BodyIndex body) {
      const Window& window = state_.windows[body];
      return window.end != first.end || window.listed != first.listed;
    };
    const auto run = static_cast<std::size_t>(std::find_if(placed.begin(), placed.end(), other) - placed.begin());
    if (first.end != kNeverStep && !first.listed) state_.wheel.set_due(placed.first(run), first.end);
    placed = placed.subspan(run);
  }
  for (const BodyIndex body : chunk.unknown) state_.changes.note(body);
  state_.boxes.include(chunk.extent);
  state_.counts.bodies += chunk.placed.size();
  state_.pool.motions.count_asked(chunk.asked);
}

// Shortens the window of a body that is faster than others until its box takes few enough cells, unless it is too large
// even for one step. Returns the box.
QuantizedAabb WindowUpdates::shrink(Block& block, Window& window, const Motion& motion) const noexcept {
  Step steps = window.end == kNeverStep ? 1 : window.end - block.from;
  QuantizedAabb box = block.boxes.get(0);
  if (steps <= 1) return box;
  const auto box_for = [&](Step wanted) {
    const double duration = state_.pool.clock.seconds_between(block.now, block.from + wanted - 1);
    BoxBlock made;
    block.quantized_grid.boxes({&motion, 1}, {&duration, 1}, made);
    return made.get(0);
  };
  if (!fits_grid(box_for(1))) return box;
  while (steps > 1 && !fits_grid(box)) {
    steps = (steps + 1) / 2;
    box = box_for(steps);
  }
  window.end = block.from + steps;
  return box;
}

// Places the bodies that a chunk has left, one by one. Call it when those that it has placed are in the grid.
void WindowUpdates::place_left(Chunk& chunk, Block& block) {
  for (const Chunk::Left& left : chunk.left) {
    const std::span<const BodyIndex> body(&left.body, 1);
    if (!is_valid(left.motion)) {
      state_.refuse(left.body);
      continue;
    }
    make_boxes(block, body, {&left.motion, 1});
    state_.windows.set(left.body, block.ends[0]);
    state_.overlaps.mark_updated(body);
    if (pairs_.spheres().any()) pairs_.spheres().note(left.body, left.motion, block.quantized_grid, block.durations[0]);
    const QuantizedAabb box = shrink(block, state_.windows[left.body], left.motion);
    state_.boxes.insert_one(left.body, box, chunk.block_visits, near_, state_.counts);
    const Step end = state_.windows[left.body].end;
    if (end != kNeverStep) state_.wheel.set_due(left.body, end);
  }
}

void WindowUpdates::find(Step now, Step from, std::span<const BodyIndex> bodies, bool tested) {
  near_.clear();
  Block block = block_at(now, from);
  Chunk& chunk = *chunk_;
  for (std::size_t done = 0; done < bodies.size(); done += kBlock) {
    place_chunk(chunk, block, bodies.subspan(done, std::min(kBlock, bodies.size() - done)));
    fold(chunk);
    GridCounts counts;
    state_.boxes.lines().insert(chunk.visits[0].visits(), state_.boxes.packed(), near_, counts);
    state_.counts += counts;
    if (!chunk.left.empty()) place_left(chunk, block);
    if (tested && near_.size() >= kNearAtOnce) test_near(now);
  }
}

void WindowUpdates::test_near(Step now) {
  if (state_.pool.filters_pairs()) drop_what_is_none();
  pairs_.test_near(now, near_);
  near_.clear();
}

void WindowUpdates::update(Step now, Step from, std::span<const BodyIndex> bodies) {
  find(now, from, bodies, true);
  test_near(now);
}

std::span<const BodyPair> WindowUpdates::find_near(Step now, std::span<const BodyIndex> bodies) {
  find(now, now, bodies, false);
  if (state_.pool.filters_pairs()) drop_what_is_none();
  return near_;
}

// Drops the near pairs that the filters exclude. They do not count for the plan, because they cost next to nothing.
void WindowUpdates::drop_what_is_none() {
  const BodyPool& pool = state_.pool;
  const std::size_t dropped = std::erase_if(near_, [&](const BodyPair& pair) { return !pool.may_pair(pair); });
  std::uint64_t& counted = state_.counts.pairs;
  counted -= std::min<std::uint64_t>(dropped, counted);
}

}  // namespace orchard::runtime::detail
