/* The broad phase for programs in C and for languages that call C. It is a thin layer over broad_phase.h, motion.h and
 * broad_queries.h, which describe the functions in detail.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits. The application's callbacks must
 * not either (no exception, no longjmp), and the broad phase refuses their calls. Pointers must not be null unless the
 * function allows it; null options stand for the default ones. A broad phase belongs to one thread at a time. Lengths
 * are in the world's unit, and times in seconds. */
#ifndef ORCHARD_RUNTIME_ORCHARD_BROAD_PHASE_H
#define ORCHARD_RUNTIME_ORCHARD_BROAD_PHASE_H

#include "orchard/runtime/orchard.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct orchard_broad_phase orchard_broad_phase;

typedef struct orchard_body {
  uint32_t index, generation; /* No body: ORCHARD_NO_BODY, 0. */
} orchard_body;
#define ORCHARD_NO_BODY 0xffffffffu

/* The state of a body at the time for which it is asked, and bounds on its motion until `expiry`: |y''(t)| <=
 * acceleration, and y''(t) . half_space <= 0 unless half_space is zero. */
typedef struct orchard_motion {
  double position[3], velocity[3];
  double radius;
  double acceleration; /* M */
  double drift;        /* An upper bound on the error of the velocity. */
  double half_space[3];
  double expiry; /* May be INFINITY. */
} orchard_motion;

/* Which pairs a body is in. Two bodies may be a pair if each one's mask has a bit of the other's category. Two bodies
 * of the same group other than 0 are always a pair if it is positive, and never if it is negative. If ignores_static
 * is true, the body has no pairs with static bodies. */
typedef struct orchard_body_filter {
  uint32_t category, mask;
  int32_t group;
  bool ignores_static;
} orchard_body_filter;

/* A callback that fills motions[i] with the motion of bodies[i] (indices) at `time`. Static bodies have indices of the
 * same kind. */
typedef void (*orchard_motion_source)(void* context, double time, const uint32_t* bodies, size_t count,
                                      orchard_motion* motions);
/* A callback that returns 0 if the two bodies are no pair. a.index < b.index. */
typedef int (*orchard_pair_filter)(void* context, orchard_body a, orchard_body b);

/* Motion bounds, given at bound_time, that the motion given at `time` does not keep, and by how much it exceeds each of
 * them: two lengths, two speeds, a length; 0 if the bound holds. See motion.h. */
typedef struct orchard_motion_bound_violation {
  orchard_body body;
  double bound_time, time;
  orchard_motion bound, given;
  double position, side, velocity, turn, radius;
} orchard_motion_bound_violation;
typedef void (*orchard_motion_bound_listener)(void* context, const orchard_motion_bound_violation* broken);

typedef struct orchard_broad_phase_options {
  double time_step, start;
  uint32_t window; /* 0: the broad phase chooses. */
  double position_slack;
  bool validate;                        /* For debugging: compares every motion with the bounds given before. */
  orchard_motion_bound_listener broken; /* Null: violations are only counted. */
  void* broken_context;
  /* Runs updates of all windows of many bodies as jobs. Several jobs call the source at once then. */
  orchard_executor executor;
} orchard_broad_phase_options;

orchard_motion orchard_default_motion(void); /* Zeros, without expiry. */
orchard_body_filter orchard_default_filter(void);
orchard_broad_phase_options orchard_default_broad_phase(void);

/* Creates a broad phase. Returns null if there is no memory. Without a source (null) there can be only static bodies.
 * The contexts must outlive it. With invalid options, it refuses everything: see orchard_broad_phase_valid(). */
orchard_broad_phase* orchard_broad_phase_new(orchard_motion_source source, void* context,
                                             const orchard_broad_phase_options* options);
void orchard_broad_phase_free(orchard_broad_phase* world);              /* May be null. */
int orchard_broad_phase_valid(const orchard_broad_phase* world);        /* 0: it refuses everything. */
size_t orchard_broad_phase_size(const orchard_broad_phase* world);      /* The number of bodies. */
double orchard_broad_phase_next_time(const orchard_broad_phase* world); /* Nothing happens before; may be INFINITY. */

/* These functions add a body. They return a body with the index ORCHARD_NO_BODY if an argument is not valid or there
 * is no memory. The importance 0 is the highest class. A null filter is the default one. */
orchard_body orchard_broad_phase_add(orchard_broad_phase* world, uint8_t importance, const orchard_body_filter* filter);
orchard_body orchard_broad_phase_add_static(orchard_broad_phase* world, const orchard_motion* place, uint8_t importance,
                                            const orchard_body_filter* filter);

/* These functions return 1; or 0, and change nothing, if there is no such body, an argument is not valid or there is
 * no memory. */
int orchard_broad_phase_remove(orchard_broad_phase* world, orchard_body body);
int orchard_broad_phase_cancel(orchard_broad_phase* world, orchard_body body); /* Cancels the last bounds. */
int orchard_broad_phase_move_static(orchard_broad_phase* world, orchard_body body, const orchard_motion* place);
int orchard_broad_phase_set_importance(orchard_broad_phase* world, orchard_body body, uint8_t importance);
int orchard_broad_phase_set_filter(orchard_broad_phase* world, orchard_body body, const orchard_body_filter* filter);
int orchard_broad_phase_set_pair_filter(orchard_broad_phase* world, orchard_pair_filter filter,
                                        void* context); /* Null: no filter. */
/* Returns the body with this index now, or ORCHARD_NO_BODY. */
orchard_body orchard_broad_phase_body(const orchard_broad_phase* world, uint32_t index);

typedef struct orchard_advance {
  double time;           /* The time of the step of the pairs; without pairs, nothing touches before. */
  const uint32_t* pairs; /* Two indices each, ascending; valid until the next call that changes the broad phase. */
  size_t pair_count;
  const uint32_t* refused; /* Bodies with invalid motions; valid as long as the pairs. */
  size_t refused_count;
  unsigned incomplete_from; /* 256: the budget did not interrupt the step. */
  size_t left_over;
  uint64_t work;
  bool time_refused;  /* t_now is not finite or too far away, or the broad phase is not valid: nothing was done. */
  bool out_of_memory; /* Memory ran out in this call: the broad phase refuses everything from now on. */
} orchard_advance;

/* Processes the steps up to t_now and stops at the first one that has pairs. Call it again with the same time until
 * there are none. The budget counts motions that are asked for; null is unlimited. If `replay` is not 0, the step ends
 * where a run with this orchard_advance.work ended, instead of at the time limit. */
orchard_advance orchard_broad_phase_advance(orchard_broad_phase* world, double t_now, const orchard_budget* budget,
                                            uint64_t replay);
/* Skips steps after a pause: the next step to be processed is the last one that is not after t. Returns the number of
 * skipped steps; 0 if nothing is due before that step, or if there is no memory. */
uint64_t orchard_broad_phase_skip_to(orchard_broad_phase* world, double t);
/* The predicted work of a step: windows that will be updated, pairs whose bounds can touch from this step on, and pairs
 * that overlapped at the last step and may still overlap. */
typedef struct orchard_steps_ahead {
  size_t updates, meetings, overlaps;
} orchard_steps_ahead;
/* Predicts the work of the `count` steps after `time`, and returns the number of steps that are known. */
size_t orchard_broad_phase_predict_load(const orchard_broad_phase* world, double time, orchard_steps_ahead* steps,
                                        size_t count);

uint64_t orchard_broad_phase_motions_asked(const orchard_broad_phase* world);
uint64_t orchard_broad_phase_motion_bound_violations(const orchard_broad_phase* world); /* Found by `validate`. */
size_t orchard_broad_phase_memory_bytes(const orchard_broad_phase* world);              /* On the heap. */

/* Queries about the bodies' spheres at the places that the source gives for query_time(), the time of the last
 * reported step. A filter includes the bodies whose category has a bit of `mask` and whose mask has a bit of
 * `category`; null stands for all ones. */
typedef struct orchard_query_filter {
  uint32_t category, mask;
} orchard_query_filter;
typedef struct orchard_body_hit {
  uint32_t body;
  double along; /* The ray enters at origin + along * direction. */
} orchard_body_hit;
typedef struct orchard_near_body {
  uint32_t body;
  double distance;
} orchard_near_body;

double orchard_broad_phase_query_time(const orchard_broad_phase* world);
/* These functions return 1 and store the hit (unless null); 0 without a hit; or -1 if the query cannot be answered: a
 * number is not finite, a direction is 0, there is no memory, or the broad phase is not valid. `longest` may be
 * INFINITY. */
int orchard_broad_phase_first_hit(orchard_broad_phase* world, const double origin[3], const double direction[3],
                                  double longest, const orchard_query_filter* filter, orchard_body_hit* hit);
int orchard_broad_phase_first_on_segment(orchard_broad_phase* world, const double p[3], const double q[3],
                                         const orchard_query_filter* filter, orchard_body_hit* hit);

/* These functions return the number of results, and store the first `room` of them (null if room is 0), in the order of
 * broad_queries.h; ORCHARD_REFUSED if the query cannot be answered. */
#define ORCHARD_REFUSED SIZE_MAX
size_t orchard_broad_phase_all_hits(orchard_broad_phase* world, const double origin[3], const double direction[3],
                                    double longest, const orchard_query_filter* filter, orchard_body_hit* hits,
                                    size_t room);
size_t orchard_broad_phase_all_on_segment(orchard_broad_phase* world, const double p[3], const double q[3],
                                          const orchard_query_filter* filter, orchard_body_hit* hits, size_t room);
size_t orchard_broad_phase_touching_sphere(orchard_broad_phase* world, const double center[3], double radius,
                                           const orchard_query_filter* filter, uint32_t* bodies, size_t room);
size_t orchard_broad_phase_touching_box(orchard_broad_phase* world, const double lower[3], const double upper[3],
                                        const orchard_query_filter* filter, uint32_t* bodies, size_t room);
/* Stores the k nearest bodies and returns their number; `near` has room for k. */
size_t orchard_broad_phase_nearest(orchard_broad_phase* world, const double point[3], size_t k,
                                   const orchard_query_filter* filter, orchard_near_body* near);

#ifdef __cplusplus
}
#endif

#endif
