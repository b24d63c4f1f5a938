#include "module.h"

using namespace orchard::web;

// The application's function for the motions of bodies, in JavaScript; `world` is the number that it was made with.
extern "C" __attribute__((import_module("orchard"), import_name("motions"))) void web_motions(
    std::uint32_t world, double time, const std::uint32_t* bodies, std::size_t count, double* motions);

namespace {

// The context of a source is its number, not an address.
void ask(void* context, double time, const std::uint32_t* bodies, std::size_t count, orchard_motion* motions) {
  std::fill_n(motions, count, orchard_default_motion());
  const auto world = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(context));
  web_motions(world, time, bodies, count, reinterpret_cast<double*>(motions));
}

orchard_body_filter filter_of(const double* row) {
  return {static_cast<std::uint32_t>(row[0]), static_cast<std::uint32_t>(row[1]), static_cast<std::int32_t>(row[2]),
          row[3] != 0};
}

orchard_query_filter query_filter_of(const double* row) {
  return {static_cast<std::uint32_t>(row[0]), static_cast<std::uint32_t>(row[1])};
}

const orchard_motion* motion_at(const double* row) { return reinterpret_cast<const orchard_motion*>(row); }

}  // namespace

// `row`: time step, start, window, position slack, validate.
ORCHARD_EXPORT(broad_new) orchard_broad_phase* web_broad_new(std::uint32_t number, int has_source, const double* row) {
  orchard_broad_phase_options options = orchard_default_broad_phase();
  options.time_step = row[0];
  options.start = row[1];
  options.window = static_cast<std::uint32_t>(row[2]);
  options.position_slack = row[3];
  options.validate = row[4] != 0;
  void* const context = reinterpret_cast<void*>(static_cast<std::uintptr_t>(number));
  return orchard_broad_phase_new(has_source != 0 ? ask : nullptr, context, &options);
}
ORCHARD_EXPORT(broad_free) void web_broad_free(orchard_broad_phase* world) { orchard_broad_phase_free(world); }
ORCHARD_EXPORT(broad_valid) int web_broad_valid(orchard_broad_phase* world) { return orchard_broad_phase_valid(world); }
ORCHARD_EXPORT(broad_size) std::size_t web_broad_size(orchard_broad_phase* world) {
  return orchard_broad_phase_size(world);
}
ORCHARD_EXPORT(broad_next_time) double web_broad_next_time(orchard_broad_phase* world) {
  return orchard_broad_phase_next_time(world);
}
ORCHARD_EXPORT(broad_query_time) double web_broad_query_time(orchard_broad_phase* world) {
  return orchard_broad_phase_query_time(world);
}
// Motions asked for, violations of motion bounds, bytes on the heap.
ORCHARD_EXPORT(broad_counts) void web_broad_counts(orchard_broad_phase* world, double* out) {
  out[0] = static_cast<double>(orchard_broad_phase_motions_asked(world));
  out[1] = static_cast<double>(orchard_broad_phase_motion_bound_violations(world));
  out[2] = static_cast<double>(orchard_broad_phase_memory_bytes(world));
}

// `row`: a filter; for a static body, a motion before it. The body's index and generation.
ORCHARD_EXPORT(broad_add)
void web_broad_add(orchard_broad_phase* world, int importance, const double* row, double* out) {
  const orchard_body_filter filter = filter_of(row);
  put(out, orchard_broad_phase_add(world, static_cast<std::uint8_t>(importance), &filter));
}
ORCHARD_EXPORT(broad_add_static)
void web_broad_add_static(orchard_broad_phase* world, int importance, const double* row, double* out) {
  const orchard_body_filter filter = filter_of(row + kMotionRow);
  put(out, orchard_broad_phase_add_static(world, motion_at(row), static_cast<std::uint8_t>(importance), &filter));
}
ORCHARD_EXPORT(broad_remove)
int web_broad_remove(orchard_broad_phase* world, std::uint32_t index, std::uint32_t generation) {
  return orchard_broad_phase_remove(world, {index, generation});
}
ORCHARD_EXPORT(broad_cancel)
int web_broad_cancel(orchard_broad_phase* world, std::uint32_t index, std::uint32_t generation) {
  return orchard_broad_phase_cancel(world, {index, generation});
}
ORCHARD_EXPORT(broad_move_static)
int web_broad_move_static(orchard_broad_phase* world, std::uint32_t index, std::uint32_t generation,
                          const double* row) {
  return orchard_broad_phase_move_static(world, {index, generation}, motion_at(row));
}
ORCHARD_EXPORT(broad_set_importance)
int web_broad_set_importance(orchard_broad_phase* world, std::uint32_t index, std::uint32_t generation,
                             int importance) {
  return orchard_broad_phase_set_importance(world, {index, generation}, static_cast<std::uint8_t>(importance));
}
ORCHARD_EXPORT(broad_set_filter)
int web_broad_set_filter(orchard_broad_phase* world, std::uint32_t index, std::uint32_t generation, const double* row) {
  const orchard_body_filter filter = filter_of(row);
  return orchard_broad_phase_set_filter(world, {index, generation}, &filter);
}

// Time, where the pairs are, their number, where the refused bodies are, their number, incomplete_from, left_over,
// work, time_refused, out_of_memory.
ORCHARD_EXPORT(broad_advance)
void web_broad_advance(orchard_broad_phase* world, double time, double work, double microseconds, double* out) {
  const orchard_budget budget = budget_of(work, microseconds);
  const orchard_advance advance = orchard_broad_phase_advance(world, time, &budget, 0);
  *out++ = advance.time;
  *out++ = static_cast<double>(reinterpret_cast<std::uintptr_t>(advance.pairs));
  *out++ = static_cast<double>(advance.pair_count);
  *out++ = static_cast<double>(reinterpret_cast<std::uintptr_t>(advance.refused));
  *out++ = static_cast<double>(advance.refused_count);
  *out++ = advance.incomplete_from;
  *out++ = static_cast<double>(advance.left_over);
  *out++ = static_cast<double>(advance.work);
  *out++ = advance.time_refused;
  *out++ = advance.out_of_memory;
}
ORCHARD_EXPORT(broad_skip_to) double web_broad_skip_to(orchard_broad_phase* world, double time) {
  return static_cast<double>(orchard_broad_phase_skip_to(world, time));
}

// Queries. `row`: the question's numbers, then category and mask.
ORCHARD_EXPORT(broad_first_hit) int web_broad_first_hit(orchard_broad_phase* world, const double* row, double* out) {
  const orchard_query_filter filter = query_filter_of(row + 7);
  orchard_body_hit hit{};
  const int found = orchard_broad_phase_first_hit(world, row, row + 3, row[6], &filter, &hit);
  out[0] = hit.body;
  out[1] = hit.along;
  return found;
}
ORCHARD_EXPORT(broad_touching_sphere)
std::size_t web_broad_touching_sphere(orchard_broad_phase* world, const double* row, std::uint32_t* bodies,
                                      std::size_t room) {
  const orchard_query_filter filter = query_filter_of(row + 4);
  return orchard_broad_phase_touching_sphere(world, row, row[3], &filter, bodies, room);
}
ORCHARD_EXPORT(broad_touching_box)
std::size_t web_broad_touching_box(orchard_broad_phase* world, const double* row, std::uint32_t* bodies,
                                   std::size_t room) {
  const orchard_query_filter filter = query_filter_of(row + 6);
  return orchard_broad_phase_touching_box(world, row, row + 3, &filter, bodies, room);
}
