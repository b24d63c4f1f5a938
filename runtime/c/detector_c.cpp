#include <array>
#include <cmath>
#include <limits>
#include <new>

#include "c/bodies_c.h"
#include "c/orchard_c.h"
#include "orchard/runtime/detector.h"
#include "orchard/runtime/orchard_detector.h"

namespace rt = orchard::runtime;

struct orchard_detector {
  orchard_state_source source;
  void* context;
  rt::Frame frame;
  std::vector<orchard_body_state> answers;
  std::vector<rt::BodyPart> parts;
  std::unique_ptr<rt::Detector> detector;
};

namespace {

using namespace rt::detail;

rt::BodyOptions options_of(const orchard_body_options* from) noexcept {
  if (from == nullptr) return {};
  return {from->importance, filter_of(&from->filter), from->continuous_speed, from->reach, from->suggest != 0};
}

rt::BodyState state_of(const orchard_body_state& from) noexcept {
  const double angular_speed = from.turns_bounded != 0 ? from.angular_speed : std::numeric_limits<double>::infinity();
  return {pose_of(from.pose), vector_of(from.velocity),   from.acceleration,
          from.drift,         vector_of(from.half_space), from.expiry,
          angular_speed};
}

orchard_body_state state_of(const rt::BodyState& from) noexcept {
  orchard_body_state result{};
  result.pose = pose_in_c(from.pose);
  std::copy(from.velocity.begin(), from.velocity.end(), result.velocity);
  std::copy(from.half_space.begin(), from.half_space.end(), result.half_space);
  result.acceleration = from.acceleration, result.drift = from.drift, result.expiry = from.expiry;
  result.turns_bounded = std::isfinite(from.angular_speed) ? 1 : 0;
  result.angular_speed = result.turns_bounded != 0 ? from.angular_speed : 0;
  return result;
}

void fill(orchard_detector& detector, double time, std::span<const rt::BodyIndex> bodies,
          std::span<rt::BodyState> states) {
  if (detector.answers.size() < bodies.size()) detector.answers.resize(bodies.size() + bodies.size() / 8);
  orchard_body_state* const answers = detector.answers.data();
  detector.source(detector.context, time, bodies.data(), bodies.size(), answers);
  for (std::size_t i = 0; i < bodies.size(); ++i) states[i] = state_of(answers[i]);
}

std::span<const rt::BodyPart> parts_of(orchard_detector& detector, const orchard_part* parts, std::size_t count) {
  detector.parts.clear();
  for (std::size_t i = 0; i < count; ++i) detector.parts.push_back({parts[i].shape, pose_of(parts[i].local)});
  return detector.parts;
}

int given(const std::optional<rt::WorldPoint>& from, orchard_world_point* to) noexcept {
  if (!from) return 0;
  to->body = body_of(from->body);
  to->part = from->part, to->triangle = from->triangle;
  to->distance = from->distance;
  std::copy(from->point.begin(), from->point.end(), to->point);
  return 1;
}

orchard_frame step(orchard_detector& detector, double time, const orchard_budget& given,
                   const rt::StepOptions& options) {
  const rt::Budget budget{given.tests, rt::detail::time_of(given.nanoseconds)};
  const rt::Frame& frame = detector.frame = detector.detector->step(time, budget, options);
  orchard_frame result{};
  result.time = frame.time, result.next_time = frame.next_time;
  result.steps = frame.steps;
  result.events = frame.events.size();
  result.pairs = frame.pairs, result.certain = frame.certain;
  result.work = frame.work, result.motions_asked = frame.motions_asked;
  result.worst_bound = frame.worst_bound;
  result.incomplete_from = frame.unfinished.incomplete_from;
  result.left_over = frame.unfinished.left_over;
  result.refused = frame.refused.size(), result.broken = frame.broken.size();
  result.time_refused = frame.time_refused, result.out_of_memory = frame.out_of_memory;
  result.steps_left = frame.unfinished.steps_left, result.skipped = frame.unfinished.skipped;
  return result;
}

static_assert(ORCHARD_FIRST_HALF_SPACE == rt::kFirstHalfSpace);

}  // namespace

extern "C" {

orchard_body_options orchard_default_body(void) { return {0, orchard_default_filter(), 0, 0, 0}; }

orchard_body_state orchard_default_state(void) { return state_of(rt::BodyState{}); }

orchard_detector_options orchard_default_detector(void) {
  const rt::DetectorOptions options;
  orchard_detector_options result{};
  result.time_step = options.time_step, result.start = options.start, result.position_slack = options.position_slack;
  result.watch = -1;
  result.steps_to_end = options.steps_to_end;
  result.max_events = options.max_events;
  result.concurrency = 1;
  return result;
}

orchard_detector* orchard_detector_new(orchard_state_source source, void* context,
                                       const orchard_detector_options* with) {
  return made_or<orchard_detector*>(nullptr, [&] {
    auto made = std::make_unique<orchard_detector>();
    made->source = source;
    made->context = context;
    const orchard_detector_options defaults = orchard_default_detector();
    if (with == nullptr) with = &defaults;
    rt::DetectorOptions options;
    options.time_step = with->time_step, options.start = with->start, options.position_slack = with->position_slack;
    if (with->watch >= 0) options.watch = with->watch != 0;
    options.steps_to_end = with->steps_to_end;
    if (with->max_events > 0) options.max_events = with->max_events;
    options.executor = {with->run, with->run_context, with->concurrency};
    if (source == nullptr) {
      made->detector = std::make_unique<rt::Detector>(options);
      return made.release();
    }
    const auto ask = [self = made.get()](double time, std::span<const rt::BodyIndex> bodies,
                                         std::span<rt::BodyState> states) { fill(*self, time, bodies, states); };
    made->detector = std::make_unique<rt::Detector>(ask, options);
    return made.release();
  });
}

void orchard_detector_free(orchard_detector* detector) { delete detector; }

orchard_shape orchard_detector_add_tree(orchard_detector* detector, const orchard_tree* tree) {
  return made_or(rt::kNoShape, [&] { return detector->detector->add_shape(tree->view); });
}
orchard_shape orchard_detector_load(orchard_detector* detector, const char* path, const char** error) {
  rt::LoadStatus status = rt::LoadStatus::out_of_memory;
  const orchard_shape shape = made_or(rt::kNoShape, [&] { return detector->detector->load_shape(path, &status); });
  if (error != nullptr) *error = shape == rt::kNoShape ? rt::message(status) : nullptr;
  return shape;
}
orchard_shape orchard_detector_add_sphere(orchard_detector* detector, double radius, const double center[3]) {
  return made_or(rt::kNoShape, [&] { return detector->detector->add_sphere(radius, vector_of(center)); });
}
orchard_shape orchard_detector_add_capsule(orchard_detector* detector, const double p[3], const double q[3],
                                           double radius) {
  return made_or(rt::kNoShape, [&] { return detector->detector->add_capsule(vector_of(p), vector_of(q), radius); });
}
orchard_shape orchard_detector_add_box(orchard_detector* detector, const double half_lengths[3]) {
  return made_or(rt::kNoShape, [&] { return detector->detector->add_box(vector_of(half_lengths)); });
}

orchard_body orchard_detector_add_body(orchard_detector* detector, const orchard_part* parts, size_t count,
                                       const orchard_body_options* options) {
  return made_or(kNobody, [&] {
    return body_of(detector->detector->add_body(parts_of(*detector, parts, count), options_of(options)));
  });
}

orchard_body orchard_detector_add_static(orchard_detector* detector, const orchard_part* parts, size_t count,
                                         const orchard_pose* pose, const orchard_body_options* options) {
  return made_or(kNobody, [&] {
    return body_of(
        detector->detector->add_static(parts_of(*detector, parts, count), pose_of(*pose), options_of(options)));
  });
}

orchard_body orchard_detector_add_half_space(orchard_detector* detector, const double normal[3], double offset,
                                             const orchard_body_options* options) {
  return made_or(kNobody, [&] {
    return body_of(detector->detector->add_half_space(vector_of(normal), offset, options_of(options)));
  });
}

int orchard_detector_remove(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector->remove(id_of(body)); });
}
int orchard_detector_cancel(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector->cancel(id_of(body)); });
}
int orchard_detector_teleport(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector->teleport(id_of(body)); });
}
int orchard_detector_move_static(orchard_detector* detector, orchard_body body, const orchard_pose* pose) {
  return changed([&] { return detector->detector->move_static(id_of(body), pose_of(*pose)); });
}
int orchard_detector_set_local(orchard_detector* detector, orchard_body body, size_t part, const orchard_pose* local) {
  return changed([&] { return detector->detector->set_local(id_of(body), part, pose_of(*local)); });
}
int orchard_detector_set_importance(orchard_detector* detector, orchard_body body, uint8_t importance) {
  return changed([&] { return detector->detector->set_importance(id_of(body), importance); });
}
int orchard_detector_set_filter(orchard_detector* detector, orchard_body body, const orchard_body_filter* filter) {
  return changed([&] { return detector->detector->set_filter(id_of(body), filter_of(filter)); });
}
int orchard_detector_set_state(orchard_detector* detector, orchard_body body, const orchard_body_state* state) {
  return changed([&] { return detector->detector->set_state(id_of(body), state_of(*state)); });
}
int orchard_detector_set_velocity(orchard_detector* detector, orchard_body body, const double velocity[3]) {
  return changed([&] { return detector->detector->set_velocity(id_of(body), vector_of(velocity)); });
}
int orchard_detector_sleep(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector->sleep(id_of(body)); });
}
int orchard_detector_wake(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector->wake(id_of(body)); });
}

int orchard_detector_set_pair_filter(orchard_detector* detector, orchard_pair_filter filter, void* context) {
  return changed([&] {
    detector->detector->set_pair_filter(filter_of(filter, context));
    return true;
  });
}

size_t orchard_detector_size(const orchard_detector* detector) { return detector->detector->size(); }

orchard_body_state orchard_detector_state(const orchard_detector* detector, orchard_body body) {
  return state_of(detector->detector->state(id_of(body)));
}
int orchard_detector_moves(const orchard_detector* detector, orchard_body body) {
  return int{detector->detector->moves(id_of(body))};
}

orchard_frame orchard_detector_step(orchard_detector* detector, double time, orchard_budget budget) {
  return step(*detector, time, budget, {});
}
orchard_frame orchard_detector_step_latest(orchard_detector* detector, double time, orchard_budget budget) {
  return step(*detector, time, budget, {.latest_only = true});
}

orchard_pair_event orchard_detector_event(const orchard_detector* detector, size_t index) {
  const rt::PairEvent& event = detector->frame.events[index];
  orchard_pair_event result{};
  result.change = static_cast<orchard_pair_change>(event.change);
  result.a = body_of(event.a), result.b = body_of(event.b);
  result.part_a = event.part_a, result.part_b = event.part_b;
  result.time = event.time;
  result.verdict = rt::detail::verdict_of(event.verdict);
  result.impact_from = event.impact_from, result.impact_to = event.impact_to;
  return result;
}

orchard_manifold orchard_detector_manifold(orchard_detector* detector, size_t index) {
  const rt::PairEvent event = detector->frame.events[index];
  return rt::detail::manifold_of(detector->detector->manifold(event));
}

int orchard_detector_cast_ray(orchard_detector* detector, const double origin[3], const double direction[3],
                              double longest, const orchard_query_filter* filter, orchard_world_point* found) {
  return made_or(0, [&] {
    const rt::Ray ray{vector_of(origin), vector_of(direction), longest};
    return given(detector->detector->cast_ray(ray, filter_of(filter)), found);
  });
}
int orchard_detector_nearest(orchard_detector* detector, const double point[3], double limit,
                             const orchard_query_filter* filter, orchard_world_point* found) {
  return made_or(0,
                 [&] { return given(detector->detector->nearest(vector_of(point), limit, filter_of(filter)), found); });
}
size_t orchard_detector_touching_sphere(orchard_detector* detector, const double center[3], double radius,
                                        const orchard_query_filter* filter, orchard_body* bodies, size_t room) {
  return made_or(std::size_t{0}, [&] {
    const auto touching = detector->detector->touching_sphere(vector_of(center), radius, filter_of(filter));
    for (std::size_t i = 0; i < std::min(room, touching.size()); ++i) bodies[i] = body_of(touching[i]);
    return touching.size();
  });
}

uint32_t orchard_detector_refused(const orchard_detector* detector, size_t index) {
  return detector->frame.refused[index];
}
uint32_t orchard_detector_broken(const orchard_detector* detector, size_t index) {
  return detector->frame.broken[index];
}
uint64_t orchard_detector_motion_bound_violations(const orchard_detector* detector) {
  return detector->detector->motion_bound_violations();
}

size_t orchard_detector_predict_load(const orchard_detector* detector, size_t count, double* pairs, double* work) {
  std::array<rt::StepLoad, 254> loads;
  const std::size_t known = detector->detector->predict_load(std::span(loads).first(std::min(count, loads.size())));
  for (std::size_t i = 0; i < known; ++i) {
    if (pairs != nullptr) pairs[i] = loads[i].pairs;
    if (work != nullptr) work[i] = loads[i].work;
  }
  return known;
}

}  // extern "C"
