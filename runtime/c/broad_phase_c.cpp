// The C interface of the broad phase, in the order of orchard_broad_phase.h.
#include <algorithm>
#include <array>

#include "c/bodies_c.h"

namespace rt = orchard::runtime;

struct orchard_broad_phase {
  orchard_broad_phase(rt::MotionSource source, const rt::BroadPhaseOptions& options)
      : world(std::move(source), options), queries(world) {}
  rt::BroadPhase world;
  rt::BodyQueries queries;
};

namespace {

using namespace rt::detail;

static_assert(sizeof(orchard_motion) == sizeof(rt::Motion));
rt::Motion motion_of(const orchard_motion& from) noexcept { return converted<rt::Motion>(from); }

rt::MotionSource source_of(orchard_motion_source source, void* context) {
  if (source == nullptr) return {};
  return [source, context](double time, std::span<const rt::BodyIndex> bodies, std::span<rt::Motion> motions) {
    ask_in_c<orchard_motion>(source, context, time, bodies, motions, motion_of);
  };
}

rt::MotionBoundViolationListener listener_of(orchard_motion_bound_listener listener, void* context) {
  if (listener == nullptr) return {};
  return [listener, context](const rt::MotionBoundViolation& broken) {
    const rt::MotionBoundExcess& by = broken.by;
    const orchard_motion_bound_violation violation = {body_of(broken.body),
                                                      broken.bound_time,
                                                      broken.time,
                                                      converted<orchard_motion>(broken.bound),
                                                      converted<orchard_motion>(broken.given),
                                                      by.position,
                                                      by.side,
                                                      by.velocity,
                                                      by.turn,
                                                      by.radius};
    listener(context, &violation);
  };
}

template <typename Ask>
int first(orchard_broad_phase* world, orchard_body_hit* hit, const Ask& ask) noexcept {
  return made_or(-1, [&] {
    const std::optional<rt::BodyHit> found = ask();
    if (found && hit != nullptr) *hit = converted<orchard_body_hit>(*found);
    return world->queries.refused() ? -1 : int{found.has_value()};
  });
}

// Stores the results of ask() as far as there is room. Returns the number of all of them, or ORCHARD_REFUSED.
template <typename InC, typename Ask>
std::size_t written(orchard_broad_phase* world, InC* to, std::size_t room, const Ask& ask) noexcept {
  return made_or(std::size_t{ORCHARD_REFUSED}, [&]() -> std::size_t {
    const auto found = ask();
    static_assert(sizeof(InC) == sizeof found[0]);
    if (world->queries.refused()) return ORCHARD_REFUSED;
    for (std::size_t i = 0; i < std::min(room, found.size()); ++i) to[i] = converted<InC>(found[i]);
    return found.size();
  });
}

}  // namespace

extern "C" {

orchard_motion orchard_default_motion(void) { return converted<orchard_motion>(rt::Motion{}); }
orchard_body_filter orchard_default_filter(void) { return converted<orchard_body_filter>(rt::BodyFilter{}); }
orchard_broad_phase_options orchard_default_broad_phase(void) {
  const rt::BroadPhaseOptions o;
  return {o.time_step, o.start, o.window, o.position_slack, o.validate, nullptr, nullptr, {nullptr, nullptr, 1}};
}

orchard_broad_phase* orchard_broad_phase_new(orchard_motion_source source, void* context,
                                             const orchard_broad_phase_options* with) {
  return made_or<orchard_broad_phase*>(nullptr, [&] {
    const orchard_broad_phase_options defaults = orchard_default_broad_phase();
    if (with == nullptr) with = &defaults;
    rt::BroadPhaseOptions options;
    options.time_step = with->time_step, options.start = with->start;
    options.window = with->window;
    options.position_slack = with->position_slack;
    options.validate = with->validate;
    options.broken = listener_of(with->broken, with->broken_context);
    options.executor = executor_of(&with->executor);
    return std::make_unique<orchard_broad_phase>(source_of(source, context), options).release();
  });
}

void orchard_broad_phase_free(orchard_broad_phase* world) { delete world; }
int orchard_broad_phase_valid(const orchard_broad_phase* world) { return int{world->world.valid()}; }
size_t orchard_broad_phase_size(const orchard_broad_phase* world) { return world->world.size(); }
double orchard_broad_phase_next_time(const orchard_broad_phase* world) { return world->world.next_time(); }

orchard_body orchard_broad_phase_add(orchard_broad_phase* world, uint8_t importance,
                                     const orchard_body_filter* filter) {
  return made_or(kNoHandle, [&] { return body_of(world->world.add(importance, filter_of(filter))); });
}
orchard_body orchard_broad_phase_add_static(orchard_broad_phase* world, const orchard_motion* place, uint8_t importance,
                                            const orchard_body_filter* filter) {
  return made_or(kNoHandle,
                 [&] { return body_of(world->world.add_static(motion_of(*place), importance, filter_of(filter))); });
}

int orchard_broad_phase_remove(orchard_broad_phase* world, orchard_body body) {
  return changed([&] { return world->world.remove(id_of(body)); });
}
int orchard_broad_phase_cancel(orchard_broad_phase* world, orchard_body body) {
  return changed([&] { return world->world.cancel(id_of(body)); });
}
int orchard_broad_phase_move_static(orchard_broad_phase* world, orchard_body body, const orchard_motion* place) {
  return changed([&] { return world->world.move_static(id_of(body), motion_of(*place)); });
}
int orchard_broad_phase_set_importance(orchard_broad_phase* world, orchard_body body, uint8_t importance) {
  return changed([&] { return world->world.set_importance(id_of(body), importance); });
}
int orchard_broad_phase_set_filter(orchard_broad_phase* world, orchard_body body, const orchard_body_filter* filter) {
  return changed([&] { return world->world.set_filter(id_of(body), filter_of(filter)); });
}
int orchard_broad_phase_set_pair_filter(orchard_broad_phase* world, orchard_pair_filter filter, void* context) {
  return changed([&] {
    world->world.set_pair_filter(filter_of(filter, context));
    return world->world.valid();
  });
}
orchard_body orchard_broad_phase_body(const orchard_broad_phase* world, uint32_t index) {
  return body_of(world->world.id_of(index));
}

orchard_advance orchard_broad_phase_advance(orchard_broad_phase* world, double t_now, const orchard_budget* budget,
                                            uint64_t replay) {
  orchard_advance result{};
  const auto advance = [&] {
    const rt::Advance now = world->world.advance(t_now, budget == nullptr ? rt::Budget{} : budget_of(*budget), replay);
    result.time = now.time;
    result.pairs = reinterpret_cast<const std::uint32_t*>(now.pairs.data()), result.pair_count = now.pairs.size();
    result.refused = now.refused.data(), result.refused_count = now.refused.size();
    result.incomplete_from = now.incomplete_from, result.left_over = now.left_over;
    result.work = now.work;
    result.time_refused = now.time_refused;
    return false;
  };
  result.out_of_memory = guarded(advance, [] { return true; });
  if (result.out_of_memory) result.time = world->world.next_time();
  return result;
}

uint64_t orchard_broad_phase_skip_to(orchard_broad_phase* world, double t) {
  return made_or(uint64_t{0}, [&] { return world->world.skip_to(t); });
}
size_t orchard_broad_phase_predict_load(const orchard_broad_phase* world, double time, orchard_steps_ahead* steps,
                                        size_t count) {
  std::array<rt::StepsAhead, 254> known;
  count = world->world.predict_load(time, std::span(known).first(std::min(count, known.size())));
  std::transform(known.begin(), known.begin() + count, steps, converted<orchard_steps_ahead, rt::StepsAhead>);
  return count;
}

uint64_t orchard_broad_phase_motions_asked(const orchard_broad_phase* world) { return world->world.motions_asked(); }
uint64_t orchard_broad_phase_motion_bound_violations(const orchard_broad_phase* world) {
  return world->world.motion_bound_violations();
}
size_t orchard_broad_phase_memory_bytes(const orchard_broad_phase* world) {
  return sizeof(*world) + world->world.memory_bytes() + world->queries.memory_bytes();
}

double orchard_broad_phase_query_time(const orchard_broad_phase* world) { return world->queries.time(); }

int orchard_broad_phase_first_hit(orchard_broad_phase* world, const double origin[3], const double direction[3],
                                  double longest, const orchard_query_filter* filter, orchard_body_hit* hit) {
  const rt::Ray ray{vector_of(origin), vector_of(direction), longest};
  return first(world, hit, [&] { return world->queries.first_hit(ray, filter_of(filter)); });
}
int orchard_broad_phase_first_on_segment(orchard_broad_phase* world, const double p[3], const double q[3],
                                         const orchard_query_filter* filter, orchard_body_hit* hit) {
  return first(world, hit,
               [&] { return world->queries.first_on_segment(vector_of(p), vector_of(q), filter_of(filter)); });
}

size_t orchard_broad_phase_all_hits(orchard_broad_phase* world, const double origin[3], const double direction[3],
                                    double longest, const orchard_query_filter* filter, orchard_body_hit* hits,
                                    size_t room) {
  const rt::Ray ray{vector_of(origin), vector_of(direction), longest};
  return written(world, hits, room, [&] { return world->queries.all_hits(ray, filter_of(filter)); });
}
size_t orchard_broad_phase_all_on_segment(orchard_broad_phase* world, const double p[3], const double q[3],
                                          const orchard_query_filter* filter, orchard_body_hit* hits, size_t room) {
  const auto ask = [&] { return world->queries.all_on_segment(vector_of(p), vector_of(q), filter_of(filter)); };
  return written(world, hits, room, ask);
}
size_t orchard_broad_phase_touching_sphere(orchard_broad_phase* world, const double center[3], double radius,
                                           const orchard_query_filter* filter, uint32_t* bodies, size_t room) {
  const auto ask = [&] { return world->queries.touching_sphere(vector_of(center), radius, filter_of(filter)); };
  return written(world, bodies, room, ask);
}
size_t orchard_broad_phase_touching_box(orchard_broad_phase* world, const double lower[3], const double upper[3],
                                        const orchard_query_filter* filter, uint32_t* bodies, size_t room) {
  const auto ask = [&] { return world->queries.touching_box(vector_of(lower), vector_of(upper), filter_of(filter)); };
  return written(world, bodies, room, ask);
}
size_t orchard_broad_phase_nearest(orchard_broad_phase* world, const double point[3], size_t k,
                                   const orchard_query_filter* filter, orchard_near_body* near) {
  return written(world, near, k, [&] { return world->queries.nearest(vector_of(point), k, filter_of(filter)); });
}

}  // extern "C"
