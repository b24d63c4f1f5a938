#include "detector/sample_states.h"

#include <algorithm>

namespace orchard::runtime {

StateSource states_of(const std::vector<BodyState>& values) {
  return [&values](double, std::span<const BodyIndex> bodies, std::span<BodyState> states) {
    const BodyState none{.pose = {.rotation = {}}};  // it has no valid rotation, so the body is refused
    for (std::size_t i = 0; i < bodies.size(); ++i) states[i] = bodies[i] < values.size() ? values[bodies[i]] : none;
  };
}

namespace detail {
namespace {

constexpr std::size_t kAhead = 8;  // loops over bodies prefetch so far ahead

}  // namespace

StateSampler::StateSampler(World& world, BroadPhase& broad, StateSource source)
    : world_(world),
      broad_(broad),
      source_(std::move(source)),
      monitor_({.position_slack = world.options.position_slack}),
      watches_(world.options.watch.value_or(true)) {}

void StateSampler::ask_for(BodyIndex index, Step step) {
  Body& body = world_.bodies[index];
  if (!body.is_asked() || body.steps.asked == step) return;
  body.steps.known_before = std::exchange(body.steps.asked, step);
  asking_.push_back(index);
}

void StateSampler::sample(Step step, std::span<const BodyIndex> bodies) {
  asking_.clear();
  make_room(asking_, world_.bodies.slots());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i + kAhead < bodies.size()) prefetch_all(world_.bodies[bodies[i + kAhead]].steps);
    ask_for(bodies[i], step);
  }
  ask_source(step);
}

void StateSampler::ask_all(Step step) {
  asking_.clear();
  const std::size_t slots = world_.bodies.slots();
  for (BodyIndex i = 0; i < slots; ++i) ask_for(i, step);
  ask_source(step);
}

// Asks the source for the states of the bodies in asking_. Jobs process the answers if they are many.
void StateSampler::ask_source(Step step) {
  if (asking_.empty()) return;
  // Without an executor, kAlone answers are processed at a time, while they are still in the cache.
  constexpr std::size_t kAlone = 256, kPerJob = 256;
  const Executor& executor = world_.options.executor;
  const std::size_t at_once = executor.run == nullptr ? std::min(asking_.size(), kAlone) : asking_.size();
  grow(answers_, at_once);
  for (std::size_t done = 0; done < asking_.size(); done += at_once) {
    const auto some = std::span(std::as_const(asking_)).subspan(done, std::min(at_once, asking_.size() - done));
    source_(world_.clock.time(step), some, std::span(answers_).first(some.size()));
    auto take_some = [&](std::size_t job) {
      const std::size_t end = std::min(some.size(), (job + 1) * kPerJob);
      for (std::size_t i = job * kPerJob; i < end; ++i) {
        if (i + kAhead < end) world_.bodies.prefetch_pose(some[i + kAhead]);
        take_answer(step, some[i], answers_[i]);
      }
    };
    run_jobs(executor, (some.size() + kPerJob - 1) / kPerJob, take_some);
  }
}

void StateSampler::take_answer(Step step, BodyIndex index, const BodyState& answer) noexcept {
  Body& body = world_.bodies[index];
  BodyState& state = body.state;
  const Pose before = state.pose;
  if (world_.any.continuous) body.before = before;
  const bool valid = is_valid(answer);
  const bool same = body.steps.moved >= 0 && before == answer.pose && body.valid == valid;
  state = answer;
  body.valid = valid;
  if (!valid) any_flawed_.store(true, std::memory_order_relaxed);
  if (!same) {
    body.steps.moved = step;
    world_.bodies.moved(index, before);
  }
  if (!body.asleep) return;
  body.frozen = true;
  state.velocity = state.half_space = {};
  state.acceleration = state.drift = state.angular_speed = 0;
  state.expiry = kInfinity;
}

Motion StateSampler::given_motion(BodyIndex index, double time) const {
  const Body& body = world_.bodies[index];
  const Motion motion = body.motion(world_.clock.time_step);
  const bool suggests = watches_ && body.options.suggest && !body.frozen && motion.radius >= 0;
  return suggests ? monitor_.suggest(index, time, motion.radius) : motion;
}

// If the bodies are watched, all have been sampled by now.
void StateSampler::answer_broad_phase(double time, std::span<const BodyIndex> asked, std::span<Motion> motions) {
  const Clock& clock = world_.clock;
  if (!sampled_all()) sample(std::llround((time - clock.start) / clock.time_step), asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    motions[i] = given_motion(asked[i], time);
    if (!watches_) continue;
    Body& body = world_.bodies[asked[i]];
    body.told = {motions[i].radius, body.relies_on_middle(clock.time_step)};
    monitor_.note_bound(asked[i], time, motions[i]);
  }
  if (!world_.options.bound_given) return;
  for (std::size_t i = 0; i < asked.size(); ++i) world_.options.bound_given(time, asked[i], motions[i]);
}

// Nearly every body of such a step would be asked for anyway.
void StateSampler::sample_all(Step step) {
  constexpr std::size_t kMinBodies = 256;
  const std::size_t slots = world_.bodies.slots();
  if (paired_.size() < kMinBodies || 2 * paired_.size() < slots || watches_ || world_.options.bound_given) return;
  ask_all(step);
  all_sampled_at_ = step;
}

// If every body has been sampled and none has to be refused, the bodies in pairs matter only to sample_all() at later
// steps. They are then found again every kKept steps only.
void StateSampler::sample_pairs(Step step, std::span<const BodyPair> pairs) {
  constexpr Step kKept = 16;
  if (all_sampled_at_ == step && !any_flawed_.load(std::memory_order_relaxed) && step < paired_at_ + kKept) return;
  paired_at_ = step;
  paired_.clear();
  grow(is_paired_, world_.bodies.slots());
  const auto note = [&](BodyIndex body) {
    if (std::exchange(is_paired_[body], 1) == 0) paired_.push_back(body);
  };
  BodyIndex last = kNoIndex;
  for (const BodyPair& pair : pairs) {
    if (pair.a != last) note(last = pair.a);
    if (!is_half_space(pair.b)) note(pair.b);
  }
  for (const BodyIndex body : paired_) is_paired_[body] = 0;
  sample(step, paired_);
  for (const BodyIndex body : paired_) {
    if (!world_.bodies[body].valid) refused_.push_back(body);
  }
}

// See section 4.4 of the dissertation.
void StateSampler::watch(Step step) {
  ask_all(step);
  for (BodyIndex i = 0; i < world_.bodies.slots(); ++i) {
    Body& body = world_.bodies[i];
    if (body.id == kNoBody || body.is_static || body.steps.asked != step) continue;
    if (!is_valid(body.motion(world_.clock.time_step))) {  // the body is refused, and its bounds do not hold any more
      if (body.told.radius >= 0) cancel(body);
    } else if (!keeps_motion_bound(i, step)) {
      broken_.push_back(i);
      cancel(body);
    }
  }
}

// Compares the motion of the body with the bound that the broad phase was given last, about the same point (the origin
// or the middle) as that bound.
bool StateSampler::keeps_motion_bound(BodyIndex index, Step step) {
  const Body& body = world_.bodies[index];
  const double time = world_.clock.time(step);
  const Motion motion = body.motion(world_.clock.time_step, body.has_middle() && body.told.by_middle);
  const bool given = !body.options.suggest || dot(motion.velocity, motion.velocity) > 0;
  const bool kept = given ? monitor_.observe(index, time, motion.position, motion.velocity)
                          : monitor_.observe(index, time, motion.position);
  if (!kept) return false;
  if (keeps_more(body, step, motion)) return true;
  monitor_.count_broken(index);
  return false;
}

// Returns whether the body keeps the bounds that the monitor does not check: those of half-spaces, the radius, and
// continuous_speed.
bool StateSampler::keeps_more(const Body& body, Step step, const Motion& motion) const noexcept {
  const BodyIndex index = body.id.index;
  const Clock& clock = world_.clock;
  const bool by_middle = body.has_middle() && world_.half_space_times.relies_on_middle(index);
  const Motion of_half_spaces = body.motion(clock.time_step, by_middle);
  if (!world_.half_space_times.motion_bound_kept(index, clock.time(step), of_half_spaces)) return false;
  if (body.told.radius >= 0 && motion.radius > body.told.radius) return false;
  if (!body.is_continuous() || body.steps.known_before != step - 1) return true;
  const Vec3 way = motion.position - Vec3(body.before.translation);
  return length(way) <= body.options.continuous_speed * clock.time_step * (1 + 1e-9);
}

void StateSampler::cancel(Body& body) {
  if (is_half_space(body.id.index)) return;
  body.told.radius = -1;
  if (watches_) monitor_.cancelled(body.id.index);
  if (!body.is_static) world_.half_space_times.update_again(body.id.index);
  broad_.cancel(body.id);
}

void StateSampler::report(Frame& frame) {
  std::sort(refused_.begin(), refused_.end());
  refused_.erase(std::unique(refused_.begin(), refused_.end()), refused_.end());
  frame.refused = refused_, frame.broken = broken_;
}

}  // namespace detail
}  // namespace orchard::runtime
