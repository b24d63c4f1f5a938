#include <array>
#include <cmath>
#include <limits>

#include "c/bodies_c.h"
#include "orchard/runtime/detector.h"
#include "orchard/runtime/orchard_detector.h"

namespace rt = orchard::runtime;

struct orchard_detector {
  rt::Detector detector;
  rt::Frame frame{};
  std::vector<rt::BodyPart> parts{};
};

namespace {

using namespace rt::detail;

rt::BodyOptions options_of(const orchard_body_options* from) noexcept {
  return from == nullptr ? rt::BodyOptions{} : converted<rt::BodyOptions>(*from);
}

rt::BodyState state_of(const orchard_body_state& from) noexcept {
  auto state = converted<rt::BodyState>(from);
  if (!from.turns_bounded) state.angular_speed = std::numeric_limits<double>::infinity();
  return state;
}

orchard_body_state state_of(const rt::BodyState& from) noexcept {
  auto state = converted<orchard_body_state>(from);
  state.turns_bounded = std::isfinite(from.angular_speed);
  if (!state.turns_bounded) state.angular_speed = 0;
  return state;
}

rt::StateSource source_of(orchard_state_source source, void* context) {
  return [source, context](double time, std::span<const rt::BodyIndex> bodies, std::span<rt::BodyState> states) {
    const auto state = [](const orchard_body_state& answer) { return state_of(answer); };
    ask_in_c<orchard_body_state>(source, context, time, bodies, states, state);
  };
}

std::span<const rt::BodyPart> parts_of(orchard_detector& detector, const orchard_part* parts, std::size_t count) {
  detector.parts.resize(count);
  std::transform(parts, parts + count, detector.parts.begin(), converted<rt::BodyPart, orchard_part>);
  return detector.parts;
}

int given(const std::optional<rt::WorldPoint>& from, orchard_world_point* to) noexcept {
  if (from) *to = converted<orchard_world_point>(*from);
  return int{from.has_value()};
}

orchard_frame step(orchard_detector& detector, double time, const orchard_budget& given,
                   const rt::StepOptions& options) {
  const rt::Frame& f = detector.frame = detector.detector.step(time, budget_of(given), options);
  const auto counts = converted<orchard_frame_counts>(static_cast<const rt::FrameCounts&>(f));
  return {f.time,
          f.next_time,
          f.steps,
          f.unfinished.steps_left,
          f.unfinished.skipped,
          f.events.size(),
          counts,
          f.unfinished.incomplete_from,
          f.unfinished.left_over,
          f.refused.size(),
          f.broken.size(),
          f.time_refused,
          f.out_of_memory};
}

static_assert(ORCHARD_FIRST_HALF_SPACE == rt::kFirstHalfSpace);
static_assert(offsetof(orchard_body_state, turns_bounded) == sizeof(rt::BodyState));
static_assert(offsetof(orchard_body_options, suggest) == offsetof(rt::BodyOptions, suggest));
static_assert(offsetof(orchard_world_point, triangle) == offsetof(rt::WorldPoint, triangle));
static_assert(sizeof(orchard_part) == sizeof(rt::BodyPart) && sizeof(orchard_step_load) == sizeof(rt::StepLoad));

}  // namespace

extern "C" {

orchard_body_options orchard_default_body(void) { return {0, orchard_default_filter(), 0, 0, 0}; }

orchard_body_state orchard_default_state(void) { return state_of(rt::BodyState{}); }

orchard_detector_options orchard_default_detector(void) {
  const rt::DetectorOptions o;
  return {o.time_step, o.start, o.position_slack, -1, o.steps_to_end, {nullptr, nullptr, 1}, o.max_events};
}

orchard_detector* orchard_detector_new(orchard_state_source source, void* context,
                                       const orchard_detector_options* with) {
  return made_or<orchard_detector*>(nullptr, [&] {
    const orchard_detector_options defaults = orchard_default_detector();
    if (with == nullptr) with = &defaults;
    rt::DetectorOptions options;
    options.time_step = with->time_step, options.start = with->start, options.position_slack = with->position_slack;
    if (with->watch >= 0) options.watch = with->watch != 0;
    options.steps_to_end = with->steps_to_end;
    if (with->max_events > 0) options.max_events = with->max_events;
    options.executor = executor_of(&with->executor);
    return new orchard_detector{source == nullptr ? rt::Detector(options)
                                                  : rt::Detector(source_of(source, context), options)};
  });
}

void orchard_detector_free(orchard_detector* detector) { delete detector; }

orchard_shape orchard_detector_add_tree(orchard_detector* detector, const orchard_tree* tree) {
  return made_or(rt::kNoShape, [&] { return detector->detector.add_shape(tree->view()); });
}
orchard_shape orchard_detector_load(orchard_detector* detector, const char* path, const char** error) {
  rt::LoadStatus status = rt::LoadStatus::out_of_memory;
  const orchard_shape shape = made_or(rt::kNoShape, [&] { return detector->detector.load_shape(path, &status); });
  if (error != nullptr) *error = shape == rt::kNoShape ? rt::message(status) : nullptr;
  return shape;
}
orchard_shape orchard_detector_add_sphere(orchard_detector* detector, double radius, const double center[3]) {
  return made_or(rt::kNoShape, [&] { return detector->detector.add_sphere(radius, vector_of(center)); });
}
orchard_shape orchard_detector_add_capsule(orchard_detector* detector, const double p[3], const double q[3],
                                           double radius) {
  return made_or(rt::kNoShape, [&] { return detector->detector.add_capsule(vector_of(p), vector_of(q), radius); });
}
orchard_shape orchard_detector_add_box(orchard_detector* detector, const double half_lengths[3]) {
  return made_or(rt::kNoShape, [&] { return detector->detector.add_box(vector_of(half_lengths)); });
}

orchard_body orchard_detector_add_body(orchard_detector* detector, const orchard_part* parts, size_t count,
                                       const orchard_body_options* options) {
  return made_or(kNoHandle, [&] {
    return body_of(detector->detector.add_body(parts_of(*detector, parts, count), options_of(options)));
  });
}

orchard_body orchard_detector_add_static(orchard_detector* detector, const orchard_part* parts, size_t count,
                                         const orchard_pose* pose, const orchard_body_options* options) {
  return made_or(kNoHandle, [&] {
    return body_of(
        detector->detector.add_static(parts_of(*detector, parts, count), pose_of(*pose), options_of(options)));
  });
}

orchard_body orchard_detector_add_half_space(orchard_detector* detector, const double normal[3], double offset,
                                             const orchard_body_options* options) {
  return made_or(kNoHandle, [&] {
    return body_of(detector->detector.add_half_space(vector_of(normal), offset, options_of(options)));
  });
}

int orchard_detector_remove(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector.remove(id_of(body)); });
}
int orchard_detector_cancel(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector.cancel(id_of(body)); });
}
int orchard_detector_teleport(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector.teleport(id_of(body)); });
}
int orchard_detector_move_static(orchard_detector* detector, orchard_body body, const orchard_pose* pose) {
  return changed([&] { return detector->detector.move_static(id_of(body), pose_of(*pose)); });
}
int orchard_detector_set_local(orchard_detector* detector, orchard_body body, size_t part, const orchard_pose* local) {
  return changed([&] { return detector->detector.set_local(id_of(body), part, pose_of(*local)); });
}
int orchard_detector_set_importance(orchard_detector* detector, orchard_body body, uint8_t importance) {
  return changed([&] { return detector->detector.set_importance(id_of(body), importance); });
}
int orchard_detector_set_filter(orchard_detector* detector, orchard_body body, const orchard_body_filter* filter) {
  return changed([&] { return detector->detector.set_filter(id_of(body), filter_of(filter)); });
}
int orchard_detector_set_state(orchard_detector* detector, orchard_body body, const orchard_body_state* state) {
  return changed([&] { return detector->detector.set_state(id_of(body), state_of(*state)); });
}
int orchard_detector_set_velocity(orchard_detector* detector, orchard_body body, const double velocity[3]) {
  return changed([&] { return detector->detector.set_velocity(id_of(body), vector_of(velocity)); });
}
int orchard_detector_sleep(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector.sleep(id_of(body)); });
}
int orchard_detector_wake(orchard_detector* detector, orchard_body body) {
  return changed([&] { return detector->detector.wake(id_of(body)); });
}

int orchard_detector_set_pair_filter(orchard_detector* detector, orchard_pair_filter filter, void* context) {
  return changed([&] {
    detector->detector.set_pair_filter(filter_of(filter, context));
    return true;
  });
}

size_t orchard_detector_size(const orchard_detector* detector) { return detector->detector.size(); }

orchard_body_state orchard_detector_state(const orchard_detector* detector, orchard_body body) {
  return state_of(detector->detector.state(id_of(body)));
}
int orchard_detector_moves(const orchard_detector* detector, orchard_body body) {
  return int{detector->detector.moves(id_of(body))};
}

orchard_frame orchard_detector_step(orchard_detector* detector, double time, orchard_budget budget) {
  return step(*detector, time, budget, {});
}
orchard_frame orchard_detector_step_latest(orchard_detector* detector, double time, orchard_budget budget) {
  return step(*detector, time, budget, {.latest_only = true});
}

orchard_pair_event orchard_detector_event(const orchard_detector* detector, size_t index) {
  const rt::PairEvent& e = detector->frame.events[index];
  return {static_cast<orchard_pair_change>(e.change), body_of(e.a),  body_of(e.b), e.part_a, e.part_b, e.time,
          converted<orchard_verdict>(e.verdict),      e.impact_from, e.impact_to};
}

orchard_manifold orchard_detector_manifold(orchard_detector* detector, size_t index) {
  const rt::PairEvent event = detector->frame.events[index];
  return converted<orchard_manifold>(detector->detector.manifold(event));
}

int orchard_detector_cast_ray(orchard_detector* detector, const double origin[3], const double direction[3],
                              double longest, const orchard_query_filter* filter, orchard_world_point* found) {
  return made_or(0, [&] {
    const rt::Ray ray{vector_of(origin), vector_of(direction), longest};
    return given(detector->detector.cast_ray(ray, filter_of(filter)), found);
  });
}
int orchard_detector_nearest(orchard_detector* detector, const double point[3], double limit,
                             const orchard_query_filter* filter, orchard_world_point* found) {
  return made_or(0,
                 [&] { return given(detector->detector.nearest(vector_of(point), limit, filter_of(filter)), found); });
}
size_t orchard_detector_touching_sphere(orchard_detector* detector, const double center[3], double radius,
                                        const orchard_query_filter* filter, orchard_body* bodies, size_t room) {
  return made_or(std::size_t{0}, [&] {
    const auto touching = detector->detector.touching_sphere(vector_of(center), radius, filter_of(filter));
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
  return detector->detector.motion_bound_violations();
}

size_t orchard_detector_predict_load(const orchard_detector* detector, orchard_step_load* loads, size_t count) {
  std::array<rt::StepLoad, 254> known;
  count = detector->detector.predict_load(std::span(known).first(std::min(count, known.size())));
  std::transform(known.begin(), known.begin() + count, loads, converted<orchard_step_load, rt::StepLoad>);
  return count;
}

}  // extern "C"
