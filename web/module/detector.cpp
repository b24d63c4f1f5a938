#include <vector>

#include "module.h"

using namespace orchard::web;

// The application's function for the states of bodies, in JavaScript; `world` is the number that it was made with.
extern "C" __attribute__((import_module("orchard"), import_name("states"))) void web_states(
    std::uint32_t world, double time, const std::uint32_t* bodies, std::size_t count, double* states);

namespace {

// A row: the pose, velocity, acceleration, drift, half-space, expiry, and the bound on the angular speed, NaN if there
// is none.
void put_state(double* to, const orchard_body_state& state) {
  to = std::copy_n(reinterpret_cast<const double*>(&state.pose), kPoseRow, to);
  to = put(to, state.velocity, 3);
  *to++ = state.acceleration;
  *to++ = state.drift;
  to = put(to, state.half_space, 3);
  *to++ = state.expiry;
  *to++ = state.turns_bounded ? state.angular_speed : std::nan("");
}

orchard_body_state state_of(const double* row) {
  orchard_body_state state = orchard_default_state();
  state.pose = pose_at(row);
  std::copy_n(row + 13, 3, state.velocity);
  state.acceleration = row[16];
  state.drift = row[17];
  std::copy_n(row + 18, 3, state.half_space);
  state.expiry = row[21];
  state.turns_bounded = !std::isnan(row[22]);
  state.angular_speed = state.turns_bounded ? row[22] : 0;
  return state;
}

void ask(void* context, double time, const std::uint32_t* bodies, std::size_t count, orchard_body_state* states) {
  std::vector<double> rows(count * kStateRow);
  for (std::size_t i = 0; i < count; ++i) put_state(&rows[i * kStateRow], orchard_default_state());
  const auto world = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(context));
  web_states(world, time, bodies, count, rows.data());
  for (std::size_t i = 0; i < count; ++i) states[i] = state_of(&rows[i * kStateRow]);
}

// Importance, category, mask, group, ignores_static, continuous speed, reach, suggest.
orchard_body_options body_options_of(const double* row) {
  orchard_body_options options = orchard_default_body();
  options.importance = static_cast<std::uint8_t>(row[0]);
  options.filter = {static_cast<std::uint32_t>(row[1]), static_cast<std::uint32_t>(row[2]),
                    static_cast<std::int32_t>(row[3]), row[4] != 0};
  options.continuous_speed = row[5];
  options.reach = row[6];
  options.suggest = row[7] != 0;
  return options;
}

// Each part is a shape, then its pose.
std::vector<orchard_part> parts_of(const double* row, std::size_t count) {
  std::vector<orchard_part> parts(count);
  for (orchard_part& part : parts) {
    part.shape = static_cast<orchard_shape>(*row);
    part.local = pose_at(row + 1);
    row += 1 + kPoseRow;
  }
  return parts;
}

orchard_query_filter query_filter_of(const double* row) {
  return {static_cast<std::uint32_t>(row[0]), static_cast<std::uint32_t>(row[1])};
}

void put_frame(double* out, const orchard_frame& frame) {
  for (const double number :
       {frame.time, frame.next_time, static_cast<double>(frame.steps), static_cast<double>(frame.events),
        static_cast<double>(frame.counts.pairs), static_cast<double>(frame.counts.certain),
        static_cast<double>(frame.counts.work), static_cast<double>(frame.counts.motions_asked),
        frame.counts.worst_bound, static_cast<double>(frame.incomplete_from), static_cast<double>(frame.left_over),
        static_cast<double>(frame.refused), static_cast<double>(frame.broken), static_cast<double>(frame.time_refused),
        static_cast<double>(frame.out_of_memory), static_cast<double>(frame.steps_left),
        static_cast<double>(frame.skipped)})
    *out++ = number;
}

int put_point(int found, const orchard_world_point& point, double* out) {
  out = put(out, point.body);
  *out++ = point.part;
  *out++ = point.triangle;
  *out++ = point.distance;
  put(out, point.point, 3);
  return found;
}

}  // namespace

// `row`: time step, start, position slack, watch, steps to end, and most events; a negative
// number keeps the default.
ORCHARD_EXPORT(detector_new)
orchard_detector* web_detector_new(std::uint32_t number, int has_source, const double* row) {
  orchard_detector_options options = orchard_default_detector();
  options.time_step = row[0];
  options.start = row[1];
  options.position_slack = row[2];
  options.watch = static_cast<int>(row[3]);
  if (row[4] >= 0) options.steps_to_end = static_cast<std::uint32_t>(row[4]);
  if (row[5] >= 0) options.max_events = static_cast<std::size_t>(row[5]);
  void* const context = reinterpret_cast<void*>(static_cast<std::uintptr_t>(number));
  return orchard_detector_new(has_source != 0 ? ask : nullptr, context, &options);
}
ORCHARD_EXPORT(detector_free) void web_detector_free(orchard_detector* world) { orchard_detector_free(world); }
ORCHARD_EXPORT(detector_size) std::size_t web_detector_size(orchard_detector* world) {
  return orchard_detector_size(world);
}

ORCHARD_EXPORT(detector_add_tree)
std::uint32_t web_detector_add_tree(orchard_detector* world, const orchard_tree* tree) {
  return orchard_detector_add_tree(world, tree);
}
ORCHARD_EXPORT(detector_add_sphere) std::uint32_t web_detector_add_sphere(orchard_detector* world, const double* row) {
  return orchard_detector_add_sphere(world, row[3], row);
}
ORCHARD_EXPORT(detector_add_capsule)
std::uint32_t web_detector_add_capsule(orchard_detector* world, const double* row) {
  return orchard_detector_add_capsule(world, row, row + 3, row[6]);
}
ORCHARD_EXPORT(detector_add_box) std::uint32_t web_detector_add_box(orchard_detector* world, const double* half) {
  return orchard_detector_add_box(world, half);
}

// `row`: options, then the parts. The body's index and generation.
ORCHARD_EXPORT(detector_add_body)
void web_detector_add_body(orchard_detector* world, const double* row, std::size_t count, double* out) {
  const orchard_body_options options = body_options_of(row);
  put(out, orchard_detector_add_body(world, parts_of(row + 8, count).data(), count, &options));
}
// `row`: options, the body's pose, then the parts.
ORCHARD_EXPORT(detector_add_static)
void web_detector_add_static(orchard_detector* world, const double* row, std::size_t count, double* out) {
  const orchard_body_options options = body_options_of(row);
  const std::vector<orchard_part> parts = parts_of(row + 8 + kPoseRow, count);
  put(out, orchard_detector_add_static(world, parts.data(), count, &pose_at(row + 8), &options));
}
// `row`: options, normal, offset.
ORCHARD_EXPORT(detector_add_half_space)
void web_detector_add_half_space(orchard_detector* world, const double* row, double* out) {
  const orchard_body_options options = body_options_of(row);
  put(out, orchard_detector_add_half_space(world, row + 8, row[11], &options));
}

// 1, or 0 and nothing is changed. What each does to a body is in orchard_detector.h.
#define ORCHARD_BODY_CHANGE(name)                                                                   \
  ORCHARD_EXPORT(detector_##name)                                                                   \
  int web_detector_##name(orchard_detector* world, std::uint32_t index, std::uint32_t generation) { \
    return orchard_detector_##name(world, {index, generation});                                     \
  }
ORCHARD_BODY_CHANGE(remove)
ORCHARD_BODY_CHANGE(cancel)
ORCHARD_BODY_CHANGE(teleport)
ORCHARD_BODY_CHANGE(sleep)
ORCHARD_BODY_CHANGE(wake)

ORCHARD_EXPORT(detector_move_static)
int web_detector_move_static(orchard_detector* world, std::uint32_t index, std::uint32_t generation,
                             const double* pose) {
  return orchard_detector_move_static(world, {index, generation}, &pose_at(pose));
}
ORCHARD_EXPORT(detector_set_local)
int web_detector_set_local(orchard_detector* world, std::uint32_t index, std::uint32_t generation, std::size_t part,
                           const double* pose) {
  return orchard_detector_set_local(world, {index, generation}, part, &pose_at(pose));
}
ORCHARD_EXPORT(detector_set_importance)
int web_detector_set_importance(orchard_detector* world, std::uint32_t index, std::uint32_t generation,
                                int importance) {
  return orchard_detector_set_importance(world, {index, generation}, static_cast<std::uint8_t>(importance));
}
ORCHARD_EXPORT(detector_set_filter)
int web_detector_set_filter(orchard_detector* world, std::uint32_t index, std::uint32_t generation, const double* row) {
  const orchard_body_filter filter{static_cast<std::uint32_t>(row[0]), static_cast<std::uint32_t>(row[1]),
                                   static_cast<std::int32_t>(row[2]), row[3] != 0};
  return orchard_detector_set_filter(world, {index, generation}, &filter);
}
ORCHARD_EXPORT(detector_set_state)
int web_detector_set_state(orchard_detector* world, std::uint32_t index, std::uint32_t generation, const double* row) {
  const orchard_body_state state = state_of(row);
  return orchard_detector_set_state(world, {index, generation}, &state);
}
ORCHARD_EXPORT(detector_set_velocity)
int web_detector_set_velocity(orchard_detector* world, std::uint32_t index, std::uint32_t generation,
                              const double* velocity) {
  return orchard_detector_set_velocity(world, {index, generation}, velocity);
}
ORCHARD_EXPORT(detector_state)
void web_detector_state(orchard_detector* world, std::uint32_t index, std::uint32_t generation, double* out) {
  put_state(out, orchard_detector_state(world, {index, generation}));
}

ORCHARD_EXPORT(detector_step)
void web_detector_step(orchard_detector* world, double time, double tests, double microseconds, int latest,
                       double* out) {
  const orchard_budget budget = budget_of(tests, microseconds);
  put_frame(out, latest != 0 ? orchard_detector_step_latest(world, time, budget)
                             : orchard_detector_step(world, time, budget));
}
// Change, both bodies, both parts, time, impact_from, impact_to, then the verdict.
ORCHARD_EXPORT(detector_event) void web_detector_event(orchard_detector* world, std::size_t index, double* out) {
  const orchard_pair_event event = orchard_detector_event(world, index);
  *out++ = event.change;
  out = put(out, event.a);
  out = put(out, event.b);
  *out++ = event.part_a;
  *out++ = event.part_b;
  *out++ = event.time;
  *out++ = event.impact_from;
  *out++ = event.impact_to;
  put(out, event.verdict);
}
ORCHARD_EXPORT(detector_manifold) void web_detector_manifold(orchard_detector* world, std::size_t index, double* out) {
  put(out, orchard_detector_manifold(world, index));
}
ORCHARD_EXPORT(detector_refused) std::uint32_t web_detector_refused(orchard_detector* world, std::size_t index) {
  return orchard_detector_refused(world, index);
}
ORCHARD_EXPORT(detector_broken) std::uint32_t web_detector_broken(orchard_detector* world, std::size_t index) {
  return orchard_detector_broken(world, index);
}

// Queries. `row`: the question's numbers, then category and mask.
ORCHARD_EXPORT(detector_cast_ray) int web_detector_cast_ray(orchard_detector* world, const double* row, double* out) {
  const orchard_query_filter filter = query_filter_of(row + 7);
  orchard_world_point point{};
  const int found = orchard_detector_cast_ray(world, row, row + 3, row[6], &filter, &point);
  return put_point(found, point, out);
}
ORCHARD_EXPORT(detector_nearest) int web_detector_nearest(orchard_detector* world, const double* row, double* out) {
  const orchard_query_filter filter = query_filter_of(row + 4);
  orchard_world_point point{};
  const int found = orchard_detector_nearest(world, row, row[3], &filter, &point);
  return put_point(found, point, out);
}
// Index and generation of each body, up to `room` bodies.
ORCHARD_EXPORT(detector_touching_sphere)
std::size_t web_detector_touching_sphere(orchard_detector* world, const double* row, orchard_body* bodies,
                                         std::size_t room) {
  const orchard_query_filter filter = query_filter_of(row + 4);
  return orchard_detector_touching_sphere(world, row, row[3], &filter, bodies, room);
}
