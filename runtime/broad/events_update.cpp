#include "events.h"

// Window updates: motions become boxes, boxes that meet become near pairs.
namespace orchard::runtime::detail {
namespace {

constexpr double kLongerWindow = 0.4;  // a window may exceed the plan's by as much of it: one update, not two

// Cells along an axis, less one; 0 if the boxes fit into the grid.
std::uint32_t excess_cells(const BoxBlock& boxes, std::size_t count) noexcept {
  std::uint32_t excess = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t more = (boxes.upper[d][i] >> kQuantumBits) - (boxes.lower[d][i] >> kQuantumBits);
      excess |= more < kMaxCellsPerAxis ? 0 : more;
    }
  }
  return excess;
}

bool cells_fit(const QuantumBox& box) noexcept {
  bool fit = true;
  for (std::size_t d = 0; d < 3; ++d) {
    fit = fit && (box.upper[d] >> kQuantumBits) - (box.lower[d] >> kQuantumBits) < kMaxCellsPerAxis;
  }
  return fit;
}

}  // namespace

struct Events::WindowUpdate {
  Step now;                              // the motions are of this step,
  Step from;                             // and count from this one
  std::array<Step, kBlock> ends;         // of the bodies' windows
  std::array<double, kBlock> durations;  // until the ends of the bodies' windows
  BoxBlock boxes;
  SweptGrid::Queue queue;
};

// The first step at which the bound does not hold or which another update is due at. Until a bound expires windows are
// equal parts.
Step Events::window_end(Step from, const Motion& motion) noexcept {
  if (from == last_from_ && motion.expiry == last_expiry_) return last_end_;
  const Step last = pool_.clock.last_before_expiry(motion.expiry);
  Step window = plan_.window;
  if (last < from + 64 * plan_.window) {
    const double steps = static_cast<double>(std::max<Step>(0, last - from) + 1);
    const double longer = options_.window > 0 ? 0 : kLongerWindow;
    const double parts = std::max(1.0, std::ceil(steps / static_cast<double>(plan_.window) - longer));
    window = std::min(kLongestWindow - 1, static_cast<Step>(std::ceil(steps / parts)));
  }
  last_from_ = from;
  last_expiry_ = motion.expiry;
  return last_end_ = from + window;
}

// The same for a body, whose bounds may have been cancelled again and again.
Step Events::window_end(Step from, BodyIndex body, const Motion& motion) noexcept {
  if (pool_.is_static(body) && !lattice_.moves()) return kNeverStep;
  const Step end = window_end(from, motion);
  return any_short_ ? std::min(end, from + windows_[body].lasting) : end;
}

// Makes the boxes of a block of bodies, until the ends of their windows. Does nothing and returns false if a motion is
// not valid.
bool Events::place(WindowUpdate& update, std::span<const BodyIndex> bodies) {
  const auto motions = std::span(std::as_const(motions_)).first(bodies.size());
  const auto duration = [&](Step end) {
    return end == kNeverStep ? 0 : static_cast<double>(end - 1 - update.now) * options_.time_step;
  };
  const Step planned = window_end(update.from, motions[0]), common = window_end(update.from, bodies[0], motions[0]);
  bool same = !pool_.any_static();
  for (const Motion& motion : motions) same = same && motion.expiry == motions[0].expiry;
  for (std::size_t i = 0; any_short_ && same && i < bodies.size(); ++i) {
    same = std::min(planned, update.from + windows_[bodies[i]].lasting) == common;
  }
  update.durations.fill(duration(common));
  bool valid = true;
  for (std::size_t i = 0; !same && i < bodies.size(); ++i) {
    update.ends[i] = window_end(update.from, bodies[i], motions[i]);
    update.durations[i] = duration(update.ends[i]);
    valid = valid && !std::isnan(motions[i].expiry);
  }
  const auto durations = std::span(update.durations).first(bodies.size());
  valid = lattice_.boxes(motions, durations, update.boxes, options_.vectors) && valid;
  const auto is_one = [](const Motion& motion) { return is_valid(motion); };
  if (!valid && !std::all_of(motions.begin(), motions.end(), is_one)) return false;

  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Window& window = windows_[bodies[i]];
    const Step end = same ? common : update.ends[i];
    const auto length = static_cast<std::uint8_t>(end == kNeverStep ? 0 : end - update.from);
    window.end = end;
    window.updated = round_;
    window.length = length;
    places_[bodies[i]] = Place::inside;
    overlaps_.mark(bodies[i], OverlapList::kUpdated);
  }
  for (std::size_t i = 0; !spheres_.empty() && i < bodies.size(); ++i) {
    spheres_[bodies[i]] = {motions[i].position, motions[i].radius, reach_of(motions[i], update.durations[i])};
  }
  means_.add(motions);
  if (!few_ && !place_in_grid(update, bodies)) same = false;
  if (same) {
    if (common != kNeverStep) wheel_.set_due(bodies, common);
    vote(common, bodies.size());
    return true;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Step end = windows_[bodies[i]].end;
    if (end != kNeverStep) wheel_.set_due(bodies.subspan(i, 1), end);
    vote(end, 1);
  }
  return true;
}

// False if a window had to be cut short.
bool Events::place_in_grid(WindowUpdate& update, std::span<const BodyIndex> bodies) {
  for (std::size_t i = 0; i < bodies.size(); ++i) boxes_[bodies[i]] = update.boxes.get(i);
  if (excess_cells(update.boxes, bodies.size()) == 0) {
    note_extent(update.boxes, bodies.size());
    return true;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!cells_fit(boxes_[bodies[i]])) shrink(update, bodies[i], i);
    if (places_[bodies[i]] == Place::inside) extent_.include(boxes_[bodies[i]]);
  }
  return false;
}

// Mostly none of them lies outside. By fours, whose boxes are all made: those after the last body are somewhere in the
// world. Quanta are below 2^31: what is outside shows in the highest bit of a difference.
void Events::note_extent(const BoxBlock& boxes, std::size_t count) noexcept {
  constexpr std::size_t kFour = 4;
  std::array<std::uint32_t, kFour> outside{};
  for (std::size_t d = 0; d < 3; ++d) {
    const std::uint32_t lower = extent_.lower[d], upper = extent_.upper[d];
    for (std::size_t i = 0; i < count; i += kFour) {
      for (std::size_t k = 0; k < kFour; ++k) {
        outside[k] |= (boxes.lower[d][i + k] - lower) | (upper - boxes.upper[d][i + k]);
      }
    }
  }
  if ((outside[0] | outside[1] | outside[2] | outside[3]) >> 31 == 0) return;
  for (std::size_t i = 0; i < count; ++i) extent_.include(boxes.get(i));
}

// Faster than the others: update it again sooner, until its box takes few enough cells.
void Events::shrink(WindowUpdate& update, BodyIndex body, std::size_t i) {
  Window& window = windows_[body];
  Step steps = window.end == kNeverStep ? 1 : window.end - update.from;
  BoxBlock box;
  places_[body] = Place::oversized;
  while (steps > 1 && places_[body] == Place::oversized) {
    steps = (steps + 1) / 2;
    window.end = update.from + steps;
    window.length = static_cast<std::uint8_t>(steps);
    const double duration = static_cast<double>(window.end - 1 - update.now) * options_.time_step;
    lattice_.boxes({&motions_[i], 1}, {&duration, 1}, box, options_.vectors);
    boxes_[body] = box.get(0);
    if (cells_fit(boxes_[body])) places_[body] = Place::inside;
  }
  update.boxes.set(i, boxes_[body]);
}

// Moves those whose new bounds are known up to `from`, with their motions, to the front; returns how many.
std::size_t Events::known_at(Step from, std::span<BodyIndex> bodies) noexcept {
  std::size_t front = 0;
  double known = std::numeric_limits<double>::infinity();  // an expiry that is late enough
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double expiry = motions_[i].expiry;
    if (expiry != known && !pool_.is_static(bodies[i])) {
      if (pool_.clock.last_before_expiry(expiry) < from) continue;
      known = expiry;
    }
    if (front < i) {
      std::swap(bodies[front], bodies[i]);
      motions_[front] = motions_[i];
    }
    ++front;
  }
  return front;
}

// Moves those whose motions are valid, with these, to the front; returns how many.
std::size_t Events::refuse_invalid(std::span<BodyIndex> bodies) {
  std::size_t front = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_valid(motions_[i])) {
      refuse(bodies[i]);
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

// Its motion is not valid: it is in no pair until it has been asked again.
void Events::refuse(BodyIndex body) {
  pool_.refuse(body);
  take_away(body);
  windows_[body].end = kUpdateDue;
  void_events(body);
  overlaps_.mark(body, OverlapList::kRefused);
  changed(body);
}

// Where `from` is a later step than now, bodies whose bounds do not reach it are left to the next step.
void Events::update_windows(Step now, Step from, std::span<const BodyIndex> bodies, Found found) {
  motions_.resize(kBlock);
  lattice_.move_to(seconds_between(lattice_from_, now));
  WindowUpdate update;
  update.now = now;
  update.from = from;
  std::array<BodyIndex, kBlock> known;
  for (std::size_t done = 0; done < bodies.size();) {
    auto block = bodies.subspan(done, std::min(kBlock, bodies.size() - done));
    pool_.ask(now, block, std::span(motions_).first(block.size()));
    done += block.size();
    if (from > now) {
      std::copy(block.begin(), block.end(), known.begin());
      const std::size_t front = known_at(from, std::span(known).first(block.size()));
      for (std::size_t i = front; i < block.size(); ++i) changed(known[i]);
      block = std::span(known).first(front);
      if (block.empty()) continue;
    }
    if (!place(update, block)) {
      if (block.data() != known.data()) std::copy(block.begin(), block.end(), known.begin());
      block = std::span(known).first(refuse_invalid(std::span(known).first(block.size())));
      if (block.empty()) continue;
      place(update, block);
    }
    insert(update, block);
    if (found == Found::tested && near_.size() >= kNearAtOnce) {
      if (!few_) grid_.finish(update.queue, boxes_, options_.vectors, near_);
      test_near(now);
    }
  }
  if (!few_) grid_.finish(update.queue, boxes_, options_.vectors, near_);
  if (found == Found::tested) {
    test_near(now);
  } else if (pool_.filters_pairs()) {
    drop_what_is_none();
  }
}

// Pairs that the filters exclude. The plan does not count them: they cost next to nothing.
void Events::drop_what_is_none() {
  grid_.discount_pairs(std::erase_if(near_, [&](const BodyPair& pair) { return !pool_.may_pair(pair); }));
}

void Events::insert(WindowUpdate& update, std::span<const BodyIndex> bodies) {
  if (few_) {
    list_.insert(bodies, update.boxes, options_.vectors, near_);
    return;
  }
  const auto oversized = [&](BodyIndex body) { return places_[body] == Place::oversized; };
  if (oversized_.empty() && std::none_of(bodies.begin(), bodies.end(), oversized)) {
    grid_.insert(update.queue, bodies, update.boxes, boxes_, options_.vectors, near_);
    return;
  }
  std::array<BodyIndex, kBlock> in_grid;
  std::size_t count = 0;
  for (const BodyIndex body : bodies) {
    if (oversized(body)) continue;
    update.boxes.set(count, boxes_[body]);
    in_grid[count++] = body;
  }
  grid_.insert(update.queue, std::span(in_grid).first(count), update.boxes, boxes_, options_.vectors, near_);
  meet_oversized(bodies);
}

// Bodies as large as several cells are compared with everything: (their number) x (the number of all) per window.
void Events::meet_oversized(std::span<const BodyIndex> bodies) {
  const auto compare = [&](BodyIndex body, BodyIndex other) {
    if (boxes_[other].meets(boxes_[body])) near_.push_back({std::min(body, other), std::max(body, other)});
  };
  for (const BodyIndex body : bodies) {
    if (places_[body] != Place::inside) continue;
    for (const BodyIndex large : oversized_) compare(body, large);
  }
  for (const BodyIndex body : bodies) {
    if (places_[body] != Place::oversized) continue;
    for (BodyIndex other = 0; other < places_.size(); ++other) {
      if (places_[other] == Place::inside) compare(body, other);
    }
    for (const BodyIndex large : oversized_) compare(body, large);
    oversized_.push_back(body);
  }
}

}  // namespace orchard::runtime::detail
