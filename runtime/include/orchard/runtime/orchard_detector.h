/* The detector for programs in C and for languages that call C: a thin cover of detector.h, which says more.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits; the application's callbacks must not
 * either (no exception, no longjmp); what they ask of the same detector is refused: no change, no step, no event.
 * Pointers must not be null unless it says so; null options are the default ones. A detector belongs to one thread at a
 * time; trees outlive it. Lengths in the world's unit, times in seconds. */
#ifndef ORCHARD_RUNTIME_ORCHARD_DETECTOR_H
#define ORCHARD_RUNTIME_ORCHARD_DETECTOR_H

#include "orchard/runtime/orchard.h"
#include "orchard/runtime/orchard_broad_phase.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct orchard_detector orchard_detector;
typedef uint32_t orchard_shape;
#define ORCHARD_NO_SHAPE 0xffffffffu

/* What is known of a body at the time of a step; the promise (velocity .. expiry) is about pose.translation. */
typedef struct orchard_body_state {
  orchard_pose pose;
  double velocity[3];
  double acceleration; /* M */
  double drift;
  double half_space[3]; /* d; zero: none */
  double expiry;        /* may be INFINITY */
  int turns_bounded;    /* 0: nothing is promised of how fast it turns; else at most */
  double angular_speed; /* this, in radians per second */
} orchard_body_state;

typedef struct orchard_part {
  orchard_shape shape;
  orchard_pose local;
} orchard_part;

typedef struct orchard_body_options {
  uint8_t importance;         /* 0 is the highest class */
  orchard_body_filter filter; /* which pairs the body is in */
  double continuous_speed;    /* 0: not continuous */
  double reach;               /* 0: as far as the parts reach */
  int suggest;                /* needs orchard_detector_options.watch: without it the body is refused */
} orchard_body_options;

/* Fills states[i] with that of bodies[i] (indices) at `time`. Static bodies have indices of the same kind. */
typedef void (*orchard_state_source)(void* context, double time, const uint32_t* bodies, size_t count,
                                     orchard_body_state* states);

/* Calls job(data, i) for each i < count, on any threads, and returns when all have returned. */
typedef void (*orchard_run_jobs)(void* context, size_t count, void (*job)(void* data, size_t index), void* data);

typedef struct orchard_detector_options {
  double time_step, start, position_slack;
  /* Whether every moving body is compared at every step with what was promised of it; 0: it is not, and contacts are
   * missed in silence where a promise is not kept; below 0: with a state source only, the default. */
  int watch;
  uint32_t steps_to_end;
  size_t max_unfinished;
  orchard_run_jobs run; /* null: serial */
  void* run_context;
  size_t concurrency;
  size_t max_fronts; /* 43 KB each, for pairs of large trees that stay close */
  size_t max_events; /* a step's call ends early once it has so many; 0: the default. See orchard_frame.steps_left */
} orchard_detector_options;

typedef enum orchard_pair_change {
  ORCHARD_BEGIN = 0,
  ORCHARD_STAY = 1,
  ORCHARD_END = 2,
  ORCHARD_POSSIBLE = 3
} orchard_pair_change;

typedef struct orchard_pair_event {
  orchard_pair_change change;
  orchard_body a, b;
  uint32_t part_a, part_b;
  double time;
  orchard_verdict verdict;       /* `finished` and `refused` are 0 */
  double impact_from, impact_to; /* NaN unless between two steps */
} orchard_pair_event;

typedef struct orchard_frame {
  double time, next_time;
  uint32_t steps;
  size_t events; /* orchard_detector_event() gives them */
  uint64_t pairs, certain, work, motions_asked;
  double worst_bound;
  unsigned incomplete_from; /* 256: the broad phase was not interrupted */
  size_t left_over, refused, broken;
  int time_refused, out_of_memory;
  uint64_t steps_left; /* not 0: max_events ended the call, and another one with the same time goes on */
  uint64_t skipped;    /* steps that orchard_detector_step_latest() left out */
} orchard_frame;

orchard_body_options orchard_default_body(void);
orchard_detector_options orchard_default_detector(void);

orchard_body_state orchard_default_state(void); /* at rest at the origin for ever */

/* Null if there is no memory. The source's context outlives it. Without a source (null) the detector keeps the states
 * and moves the bodies: see orchard_detector_set_state. */
orchard_detector* orchard_detector_new(orchard_state_source source, void* context,
                                       const orchard_detector_options* options);
void orchard_detector_free(orchard_detector* detector); /* null is fine */

/* ORCHARD_NO_SHAPE, or a body whose index is ORCHARD_NO_BODY: what was handed over is not valid, or no memory. */
orchard_shape orchard_detector_add_tree(orchard_detector* detector, const orchard_tree* tree);
/* A tree of the detector's own; `error`, unless null, gets a sentence if there is none, else null. */
orchard_shape orchard_detector_load(orchard_detector* detector, const char* path, const char** error);
orchard_shape orchard_detector_add_sphere(orchard_detector* detector, double radius, const double center[3]);
orchard_shape orchard_detector_add_capsule(orchard_detector* detector, const double p[3], const double q[3],
                                           double radius);
orchard_shape orchard_detector_add_box(orchard_detector* detector, const double half_lengths[3]);
orchard_body orchard_detector_add_body(orchard_detector* detector, const orchard_part* parts, size_t count,
                                       const orchard_body_options* options);
orchard_body orchard_detector_add_static(orchard_detector* detector, const orchard_part* parts, size_t count,
                                         const orchard_pose* pose, const orchard_body_options* options);
/* The first half-space that is added has the index ORCHARD_FIRST_HALF_SPACE, the next one the next, and none is used
 * again; indices of all other bodies are smaller. */
#define ORCHARD_FIRST_HALF_SPACE 0xf0000000u
orchard_body orchard_detector_add_half_space(orchard_detector* detector, const double normal[3], double offset,
                                             const orchard_body_options* options);

/* 1, or 0 and nothing is changed. */
int orchard_detector_remove(orchard_detector* detector, orchard_body body);
int orchard_detector_cancel(orchard_detector* detector, orchard_body body);
int orchard_detector_teleport(orchard_detector* detector, orchard_body body);
int orchard_detector_move_static(orchard_detector* detector, orchard_body body, const orchard_pose* pose);
int orchard_detector_set_local(orchard_detector* detector, orchard_body body, size_t part, const orchard_pose* local);
int orchard_detector_set_importance(orchard_detector* detector, orchard_body body, uint8_t importance);
/* Null is the default one. */
int orchard_detector_set_filter(orchard_detector* detector, orchard_body body, const orchard_body_filter* filter);
/* Of detectors without a source: from the time of the last step on the body is there, and goes straight on. */
int orchard_detector_set_state(orchard_detector* detector, orchard_body body, const orchard_body_state* state);
int orchard_detector_set_velocity(orchard_detector* detector, orchard_body body, const double velocity[3]);
int orchard_detector_sleep(orchard_detector* detector, orchard_body body);
int orchard_detector_wake(orchard_detector* detector, orchard_body body);
int orchard_detector_set_pair_filter(orchard_detector* detector, orchard_pair_filter filter,
                                     void* context); /* or null */
size_t orchard_detector_size(const orchard_detector* detector);
/* At the last step without a source, else as of when it was asked for last; what is static is at rest. */
orchard_body_state orchard_detector_state(const orchard_detector* detector, orchard_body body);
int orchard_detector_moves(const orchard_detector* detector, orchard_body body); /* neither static nor a half-space */

orchard_frame orchard_detector_step(orchard_detector* detector, double time, orchard_budget budget);
/* Answers the last step up to `time` alone and leaves out those before it, for after a pause. */
orchard_frame orchard_detector_step_latest(orchard_detector* detector, double time, orchard_budget budget);
/* Of the last step; index < events. */
orchard_pair_event orchard_detector_event(const orchard_detector* detector, size_t index);
/* Where the two touch, at up to four points, and how they come apart: see Detector::manifold. Without points, and
 * "maybe", if the event's answer is not yes or its bodies are gone. */
orchard_manifold orchard_detector_manifold(orchard_detector* detector, size_t index);
/* All bodies as of the last step: see Detector::cast_ray. 1, or 0 where there is none. Null filter: all bodies. */
typedef struct orchard_world_point {
  orchard_body body;
  uint32_t part, triangle;
  double distance; /* along a ray: in lengths of its direction */
  double point[3];
} orchard_world_point;
int orchard_detector_cast_ray(orchard_detector* detector, const double origin[3], const double direction[3],
                              double longest, const orchard_query_filter* filter, orchard_world_point* found);
int orchard_detector_nearest(orchard_detector* detector, const double point[3], double limit,
                             const orchard_query_filter* filter, orchard_world_point* found);
/* How many bodies a solid sphere touches; the first `room` of them, in ascending order of indices, are written. */
size_t orchard_detector_touching_sphere(orchard_detector* detector, const double center[3], double radius,
                                        const orchard_query_filter* filter, orchard_body* bodies, size_t room);
uint32_t orchard_detector_refused(const orchard_detector* detector, size_t index);
uint32_t orchard_detector_broken(const orchard_detector* detector, size_t index);
uint64_t orchard_detector_motion_bound_violations(const orchard_detector* detector);
/* What the next `count` steps will cost: fills the arrays (each may be null), and returns how many are known. */
size_t orchard_detector_predict_load(const orchard_detector* detector, size_t count, double* pairs, double* work);

#ifdef __cplusplus
}
#endif

#endif
