/* The broad phase for programs in C and for languages that call C: a thin cover of broad_phase.h, motion.h and
 * broad_queries.h, which say more.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits; the application's callbacks must not
 * either (no exception, no longjmp), and what they ask of the same broad phase is refused. Pointers must not be null
 * unless it says so; null options are the default ones. A broad phase belongs to one thread at a time. Lengths in the
 * world's unit, times in seconds. */
#ifndef ORCHARD_RUNTIME_ORCHARD_BROAD_PHASE_H
#define ORCHARD_RUNTIME_ORCHARD_BROAD_PHASE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct orchard_broad_phase orchard_broad_phase;

typedef struct orchard_body {
  uint32_t index, generation; /* no body: ORCHARD_NO_BODY, 0 */
} orchard_body;
#define ORCHARD_NO_BODY 0xffffffffu

/* What is known of a body at the time it is asked for: for that time <= t <= expiry |y''(t)| <= acceleration, and
 * y''(t) . half_space <= 0 unless half_space is zero. */
typedef struct orchard_motion {
  double position[3], velocity[3];
  double radius;
  double acceleration; /* M */
  double drift;        /* bound on how wrong the velocity is */
  double half_space[3];
  double expiry; /* may be INFINITY */
} orchard_motion;

/* Two bodies may be a pair if each one's mask has a bit of the other's category; of two with the same group, unless it
 * is 0: always if it is positive, never if it is negative. If ignores_static is not 0, it has no pairs with static
 * bodies. */
typedef struct orchard_body_filter {
  uint32_t category, mask;
  int32_t group;
  int ignores_static;
} orchard_body_filter;

/* Fills motions[i] with that of bodies[i] (indices) at `time`. Static bodies have indices of the same kind. */
typedef void (*orchard_motion_source)(void* context, double time, const uint32_t* bodies, size_t count,
                                      orchard_motion* motions);
/* 0: the two are no pair. a.index < b.index. */
typedef int (*orchard_pair_filter)(void* context, orchard_body a, orchard_body b);

/* A promise, given at bound_time, that what was given at `time` does not keep: by how much each bound is exceeded,
 * two lengths, two speeds, a length; 0: it holds. See motion.h. */
typedef struct orchard_motion_bound_violation {
  orchard_body body;
  double bound_time, time;
  orchard_motion bound, given;
  double position, side, velocity, turn, radius;
} orchard_motion_bound_violation;
typedef void (*orchard_motion_bound_listener)(void* context, const orchard_motion_bound_violation* broken);

typedef struct orchard_broad_phase_options {
  double time_step, start;
  uint32_t window; /* 0: as it chooses */
  double position_slack;
  int validate;                         /* debugging: compare every motion with what was promised before */
  orchard_motion_bound_listener broken; /* null: broken promises are only counted */
  void* broken_context;
  /* Updates of all windows of many bodies as jobs: run(run_context, count, job, data) calls job(data, i) for each i <
   * count, on any threads, and returns when all have returned. The source is called by several at once then. Null: none
   */
  void (*run)(void* context, size_t count, void (*job)(void* data, size_t index), void* data);
  void* run_context;
  size_t concurrency; /* jobs that may run at once */
} orchard_broad_phase_options;

orchard_motion orchard_default_motion(void); /* zeros, and for ever */
orchard_body_filter orchard_default_filter(void);
orchard_broad_phase_options orchard_default_broad_phase(void);

/* Null if there is no memory. Without a source (null) there can be static bodies only. The contexts outlive it. Options
 * that are not valid make one that refuses everything: see orchard_broad_phase_valid(). */
orchard_broad_phase* orchard_broad_phase_new(orchard_motion_source source, void* context,
                                             const orchard_broad_phase_options* options);
void orchard_broad_phase_free(orchard_broad_phase* world);              /* null is fine */
int orchard_broad_phase_valid(const orchard_broad_phase* world);        /* 0: it refuses everything */
size_t orchard_broad_phase_size(const orchard_broad_phase* world);      /* bodies */
double orchard_broad_phase_next_time(const orchard_broad_phase* world); /* nothing happens before; may be INFINITY */

/* A body whose index is ORCHARD_NO_BODY: what was handed over is not valid, or no memory. Importance: 0 is the highest
 * class. Filter: null is the default one. */
orchard_body orchard_broad_phase_add(orchard_broad_phase* world, uint8_t importance, const orchard_body_filter* filter);
orchard_body orchard_broad_phase_add_static(orchard_broad_phase* world, const orchard_motion* place, uint8_t importance,
                                            const orchard_body_filter* filter);

/* 1, or 0 and nothing is changed: there is no such body, what was handed over is not valid, or no memory. */
int orchard_broad_phase_remove(orchard_broad_phase* world, orchard_body body);
int orchard_broad_phase_cancel(orchard_broad_phase* world, orchard_body body); /* its bounds hold no longer */
int orchard_broad_phase_move_static(orchard_broad_phase* world, orchard_body body, const orchard_motion* place);
int orchard_broad_phase_set_importance(orchard_broad_phase* world, orchard_body body, uint8_t importance);
int orchard_broad_phase_set_filter(orchard_broad_phase* world, orchard_body body, const orchard_body_filter* filter);
int orchard_broad_phase_set_pair_filter(orchard_broad_phase* world, orchard_pair_filter filter,
                                        void* context); /* null: none */
/* The body that has the index now; ORCHARD_NO_BODY: none. */
orchard_body orchard_broad_phase_body(const orchard_broad_phase* world, uint32_t index);

typedef struct orchard_work_budget {
  uint64_t work;        /* motions asked for, or UINT64_MAX */
  uint64_t nanoseconds; /* or UINT64_MAX */
  uint64_t replay;      /* not 0: end where a run did whose orchard_advance.work this was, in place of nanoseconds */
} orchard_work_budget;

typedef struct orchard_advance {
  double time;           /* of the step that the pairs are of; without pairs: nothing touches before */
  const uint32_t* pairs; /* two indices each, ascending; valid until the next call that changes the broad phase */
  size_t pair_count;
  const uint32_t* refused; /* bodies whose motions were not valid; as long */
  size_t refused_count;
  unsigned incomplete_from; /* 256: the budget did not interrupt */
  size_t left_over;
  uint64_t work;
  int time_refused;  /* t_now is not finite or too far away, or the broad phase is not valid: nothing was done */
  int out_of_memory; /* in this call: it refuses everything from now on */
} orchard_advance;

/* The first step up to t_now that has pairs; to be called again with the same time until it has none. Budget: null is
 * none. */
orchard_advance orchard_broad_phase_advance(orchard_broad_phase* world, double t_now,
                                            const orchard_work_budget* budget);
/* Leaves out the steps before the last one that is not after t, for after a pause. Returns how many; 0 if nothing is
 * due in between, or without memory. */
uint64_t orchard_broad_phase_skip_to(orchard_broad_phase* world, double t);
/* What is due at the `count` steps after `time`: fills the arrays (each may be null), and returns how many are known.
 */
size_t orchard_broad_phase_predict_load(const orchard_broad_phase* world, double time, size_t count, size_t* updates,
                                        size_t* meetings, size_t* overlaps);

uint64_t orchard_broad_phase_motions_asked(const orchard_broad_phase* world);
uint64_t orchard_broad_phase_motion_bound_violations(const orchard_broad_phase* world); /* found by `validate` */
size_t orchard_broad_phase_memory_bytes(const orchard_broad_phase* world);              /* held on the heap */

/* Queries: about the bodies' spheres where the source says they are at query_time(), that of the last step reported.
 * Of those whose category has a bit of `mask` and whose mask has one of `category`; null: all ones. */
typedef struct orchard_query_filter {
  uint32_t category, mask;
} orchard_query_filter;
typedef struct orchard_body_hit {
  uint32_t body;
  double along; /* enters at origin + along * direction */
} orchard_body_hit;
typedef struct orchard_near_body {
  uint32_t body;
  double distance;
} orchard_near_body;

double orchard_broad_phase_query_time(const orchard_broad_phase* world);
/* 1 and the hit (null: not wanted), or 0; -1 where nothing can be said: numbers that are not finite, a direction of 0,
 * no memory, a broad phase that is not valid. `longest` may be INFINITY. */
int orchard_broad_phase_first_hit(orchard_broad_phase* world, const double origin[3], const double direction[3],
                                  double longest, const orchard_query_filter* filter, orchard_body_hit* hit);
int orchard_broad_phase_first_on_segment(orchard_broad_phase* world, const double p[3], const double q[3],
                                         const orchard_query_filter* filter, orchard_body_hit* hit);

/* How many there are, of which the first `room` are written down (null if room is 0), in the order of broad_queries.h;
 * ORCHARD_REFUSED where nothing can be said. */
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
/* The k nearest ones; `near` has room for as many. */
size_t orchard_broad_phase_nearest(orchard_broad_phase* world, const double point[3], size_t k,
                                   const orchard_query_filter* filter, orchard_near_body* near);

#ifdef __cplusplus
}
#endif

#endif
