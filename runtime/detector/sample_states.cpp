#include "detector/detector_state.h"

// Where bodies are, and what the broad phase may rely on.
namespace orchard::runtime {

using detail::Body;

// What the source says, or what the monitor makes of it.
Motion Detector::State::promise_of(BodyIndex index, double time) const {
  const Motion motion = bodies.motion_of(index, clock.time_step);
  const Body& body = bodies[index];
  const bool suggests = watches && body.suggest && !body.frozen && motion.radius >= 0;
  return suggests ? monitor.suggest(index, time, motion.radius) : motion;
}

// For the broad phase. Whoever watches has asked for everybody by now.
void Detector::State::motions(double time, std::span<const BodyIndex> asked, std::span<Motion> answers) {
  if (!all_asked) bodies.ask(std::llround((time - clock.start) / clock.time_step), time, asked, options.executor);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    answers[i] = promise_of(asked[i], time);
    if (!watches) continue;
    Body& body = bodies[asked[i]];
    body.told_radius = answers[i].radius;
    body.told_by_middle = bodies.goes_by_middle(asked[i], clock.time_step);
    monitor.promised(asked[i], time, answers[i]);
  }
  if (!options.promised) return;
  for (std::size_t i = 0; i < asked.size(); ++i) options.promised(time, asked[i], answers[i]);
}

// So that the broad phase's jobs may run at once. Where most bodies were in pairs at the last step, nearly everybody is
// asked about this one anyway.
void Detector::State::ask_all(Step step) {
  constexpr std::size_t kMinBodies = 256;
  all_asked = false;
  const bool many = involved.size() >= kMinBodies && 2 * involved.size() >= bodies.slots();
  if (!many || watches || options.promised) return;
  bodies.ask_everyone(step, clock.time(step), options.executor);
  all_asked = true;
  all_asked_at = step;
}

// 4.4: before the broad phase relies on anything at this step, everybody's state is compared with what it relies on.
void Detector::State::watch(Step step) {
  const double time = clock.time(step);
  everyone.clear();
  for (BodyIndex i = 0; i < bodies.slots(); ++i) {
    if (bodies[i].id != kNoBody && !bodies[i].is_static && !bodies[i].frozen) everyone.push_back(i);
  }
  bodies.ask(step, time, everyone, options.executor);
  for (const BodyIndex i : everyone) {
    Body& body = bodies[i];
    if (!is_valid(bodies.motion_of(i, clock.time_step))) {  // what it has promised holds no longer: it is refused
      if (body.told_radius >= 0) update_again(body);
      continue;
    }
    // Of what the promise was about, whatever this state promises.
    const Motion motion = bodies.motion_of(i, clock.time_step, body.has_middle() && body.told_by_middle);
    const bool given = !body.suggest || dot(motion.velocity, motion.velocity) > 0;
    bool kept =
        given ? monitor.observe(i, time, motion.position, motion.velocity) : monitor.observe(i, time, motion.position);
    if (kept && !keeps_more(body, step, motion)) {
      kept = false;
      monitor.count_broken(i);
    }
    if (kept) continue;
    broken.push_back(i);
    update_again(body);
  }
}

// Besides the monitor's promise: what half-spaces rely on, the size, and the speed of what is continuous.
bool Detector::State::keeps_more(const Body& body, Step step, const Motion& motion) const noexcept {
  const BodyIndex index = body.id.index;
  const bool by_middle = body.has_middle() && halves.goes_by_middle(index);
  if (!halves.promise_kept(index, clock.time(step), bodies.motion_of(index, clock.time_step, by_middle))) return false;
  if (body.told_radius >= 0 && motion.radius > body.told_radius) return false;
  if (!(body.continuous_speed > 0) || body.known_before != step - 1) return true;
  const Vec3 way = motion.position - Vec3(bodies.before(index).translation);
  return detail::length(way) <= body.continuous_speed * clock.time_step * (1 + 1e-9);
}

void Detector::State::note_refused(std::span<const BodyIndex> more) {
  refused.insert(refused.end(), more.begin(), more.end());
}

}  // namespace orchard::runtime
