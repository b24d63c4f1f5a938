#include "detector/sample_states.h"

#include <algorithm>

namespace orchard::runtime::detail {

StateSampler::StateSampler(World& world, BroadPhase& broad)
    : world_(world),
      broad_(broad),
      monitor_({.position_slack = world.options.position_slack}),
      watches_(world.options.watch.value_or(true)) {}

void StateSampler::sample(Step step, double time, std::span<const BodyIndex> bodies) {
  world_.bodies.ask(step, time, bodies, world_.options.executor);
}

Motion StateSampler::given_motion(BodyIndex index, double time) const {
  const Motion motion = world_.bodies.motion_of(index, world_.clock.time_step);
  const Body& body = world_.bodies[index];
  const bool suggests = watches_ && body.suggest && !body.frozen && motion.radius >= 0;
  return suggests ? monitor_.suggest(index, time, motion.radius) : motion;
}

// One that watches has sampled every body by now.
void StateSampler::answer_broad_phase(double time, std::span<const BodyIndex> asked, std::span<Motion> motions) {
  const Clock& clock = world_.clock;
  if (!sampled_all_) sample(std::llround((time - clock.start) / clock.time_step), time, asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    motions[i] = given_motion(asked[i], time);
    if (!watches_) continue;
    Body& body = world_.bodies[asked[i]];
    body.told_radius = motions[i].radius;
    body.told_by_middle = world_.bodies.relies_on_middle(asked[i], clock.time_step);
    monitor_.note_bound(asked[i], time, motions[i]);
  }
  if (!world_.options.bound_given) return;
  for (std::size_t i = 0; i < asked.size(); ++i) world_.options.bound_given(time, asked[i], motions[i]);
}

// Nearly every body is asked about at this step anyway.
void StateSampler::sample_all(Step step) {
  constexpr std::size_t kMinBodies = 256;
  sampled_all_ = false;
  const bool many = paired_.size() >= kMinBodies && 2 * paired_.size() >= world_.bodies.slots();
  if (!many || watches_ || world_.options.bound_given) return;
  world_.bodies.ask_everyone(step, world_.clock.time(step), world_.options.executor);
  sampled_all_ = true;
  all_sampled_at_ = step;
}

// Where every body has been sampled and none is to be refused, which bodies are in pairs only matters for what is done
// at the next steps.
void StateSampler::sample_pairs(Step step, std::span<const BodyPair> pairs) {
  constexpr Step kKept = 16;
  const BodyTable& bodies = world_.bodies;
  if (all_sampled_at_ == step && bodies.all_valid() && step < paired_at_ + kKept) return;
  paired_at_ = step;
  paired_.clear();
  grow(is_paired_, bodies.slots());
  const auto note = [&](BodyIndex body) {
    if (is_paired_[body] != 0) return;
    paired_.push_back(body);
    is_paired_[body] = 1;
  };
  BodyIndex last = kNoIndex;
  for (const BodyPair& pair : pairs) {
    if (pair.a != last) note(last = pair.a);
    if (!is_half_space(pair.b)) note(pair.b);
  }
  for (const BodyIndex body : paired_) is_paired_[body] = 0;
  sample(step, paired_);
  for (const BodyIndex body : paired_) {
    if (!bodies[body].valid) refused_.push_back(body);
  }
}

// Section 4.4 of the dissertation.
void StateSampler::watch(Step step) {
  const BodyTable& bodies = world_.bodies;
  everyone_.clear();
  for (BodyIndex i = 0; i < bodies.slots(); ++i) {
    if (bodies[i].id != kNoBody && !bodies[i].is_static && !bodies[i].frozen) everyone_.push_back(i);
  }
  sample(step, everyone_);
  for (const BodyIndex i : everyone_) {
    Body& body = world_.bodies[i];
    if (!is_valid(bodies.motion_of(i, world_.clock.time_step))) {  // it is refused, and its bounds do not hold any more
      if (body.told_radius >= 0) cancel(body);
    } else if (!keeps_motion_bound(i, step)) {
      broken_.push_back(i);
      cancel(body);
    }
  }
}

// Compares with the bounds of the last motion that was given, about the same point (origin or middle) as they were.
bool StateSampler::keeps_motion_bound(BodyIndex index, Step step) {
  const Body& body = world_.bodies[index];
  const double time = world_.clock.time(step);
  const Motion motion =
      world_.bodies.motion_of(index, world_.clock.time_step, body.has_middle() && body.told_by_middle);
  const bool given = !body.suggest || dot(motion.velocity, motion.velocity) > 0;
  const bool kept = given ? monitor_.observe(index, time, motion.position, motion.velocity)
                          : monitor_.observe(index, time, motion.position);
  if (!kept) return false;
  if (keeps_more(body, step, motion)) return true;
  monitor_.count_broken(index);
  return false;
}

// Whether the bounds hold that the monitor does not check: those of half-spaces, the radius, and continuous_speed.
bool StateSampler::keeps_more(const Body& body, Step step, const Motion& motion) const noexcept {
  const BodyIndex index = body.id.index;
  const Clock& clock = world_.clock;
  const bool by_middle = body.has_middle() && world_.half_space_times.relies_on_middle(index);
  const Motion of_half_spaces = world_.bodies.motion_of(index, clock.time_step, by_middle);
  if (!world_.half_space_times.motion_bound_kept(index, clock.time(step), of_half_spaces)) return false;
  if (body.told_radius >= 0 && motion.radius > body.told_radius) return false;
  if (!(body.continuous_speed > 0) || body.known_before != step - 1) return true;
  const Vec3 way = motion.position - Vec3(body.before.translation);
  return length(way) <= body.continuous_speed * clock.time_step * (1 + 1e-9);
}

void StateSampler::cancel(Body& body) {
  if (is_half_space(body.id.index)) return;
  body.told_radius = -1;
  if (watches_) monitor_.cancelled(body.id.index);
  if (!body.is_static) world_.half_space_times.update_again(body.id.index);
  broad_.cancel(body.id);
}

StateSampler::Faults StateSampler::faults() {
  std::sort(refused_.begin(), refused_.end());
  refused_.erase(std::unique(refused_.begin(), refused_.end()), refused_.end());
  return {refused_, broken_};
}

std::size_t StateSampler::memory_bytes() const noexcept {
  return monitor_.memory_bytes() + bytes_of(everyone_, refused_, broken_, paired_, is_paired_);
}

}  // namespace orchard::runtime::detail
