/* The detector for programs in C and for languages that call C. It is a thin layer over detector.h, which describes
 * the functions in detail.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits. The application's callbacks must
 * not either (no exception, no longjmp), and the detector refuses their calls: no change, no step, no event. Pointers
 * must not be null unless the function allows it; null options stand for the default ones. A detector belongs to one
 * thread at a time; trees must outlive it. Lengths are in the world's unit, and times in seconds. */
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

/* The state of a body at the time of a step. The motion bounds (velocity .. expiry) are about pose.translation. */
typedef struct orchard_body_state {
  orchard_pose pose;
  double velocity[3];
  double acceleration; /* M */
  double drift;
  double half_space[3]; /* d; zero: no half-space. */
  double expiry;        /* May be INFINITY. */
  double angular_speed; /* If turns_bounded: at most this, in radians per second. */
  bool turns_bounded;   /* False: the angular speed is not bounded. */
} orchard_body_state;

typedef struct orchard_part {
  orchard_shape shape;
  orchard_pose local;
} orchard_part;

typedef struct orchard_body_options {
  uint8_t importance;         /* 0 is the highest class. */
  orchard_body_filter filter; /* Which pairs the body is in. */
  double continuous_speed;    /* 0: not continuous. */
  double reach;               /* 0: as far as the parts reach. */
  bool suggest;               /* Requires orchard_detector_options.watch; otherwise the body is refused. */
} orchard_body_options;

/* A callback that fills states[i] with the state of bodies[i] (indices) at `time`. Static bodies have indices of the
 * same kind. */
typedef void (*orchard_state_source)(void* context, double time, const uint32_t* bodies, size_t count,
                                     orchard_body_state* states);

typedef struct orchard_detector_options {
  double time_step, start, position_slack;
  /* Whether each step compares every moving body with its motion bounds. 0: no comparison, and contacts are missed
   * silently if bounds are not kept. Below 0, the default: with a state source only. */
  int watch;
  uint32_t steps_to_end;
  orchard_executor executor;
  size_t max_events; /* A call ends after a step with this many events; 0: the default. See orchard_frame.steps_left. */
} orchard_detector_options;

enum { ORCHARD_BEGIN = 0, ORCHARD_STAY = 1, ORCHARD_END = 2, ORCHARD_POSSIBLE = 3 };
typedef uint8_t orchard_pair_change; /* One of these. */

typedef struct orchard_pair_event {
  orchard_pair_change change;
  orchard_body a, b;
  uint32_t part_a, part_b;
  double time;
  orchard_verdict verdict;       /* `finished` and `refused` are false. */
  double impact_from, impact_to; /* NaN unless the contact is between two steps. */
} orchard_pair_event;

/* What the steps of a call did: see FrameCounts in detector.h. */
typedef struct orchard_frame_counts {
  uint64_t pairs, certain, work, motions_asked;
  double worst_bound;
} orchard_frame_counts;

typedef struct orchard_frame {
  double time, next_time;
  uint32_t steps;
  uint64_t steps_left; /* Not 0: max_events ended the call; another one with the same time continues. */
  uint64_t skipped;    /* Steps that orchard_detector_step_latest() left out. */
  size_t events;       /* The number of events; orchard_detector_event() returns them. */
  orchard_frame_counts counts;
  unsigned incomplete_from; /* 256: the broad phase was not interrupted. */
  size_t left_over, refused, broken;
  bool time_refused, out_of_memory;
} orchard_frame;

orchard_body_options orchard_default_body(void);
orchard_detector_options orchard_default_detector(void);

orchard_body_state orchard_default_state(void); /* At rest at the origin, without expiry. */

/* Creates a detector. Returns null if there is no memory. The source's context must outlive it. Without a source
 * (null), the detector keeps the states and moves the bodies: see orchard_detector_set_state(). */
orchard_detector* orchard_detector_new(orchard_state_source source, void* context,
                                       const orchard_detector_options* options);
void orchard_detector_free(orchard_detector* detector); /* May be null. */

/* The functions that add shapes and bodies return ORCHARD_NO_SHAPE, or a body with the index ORCHARD_NO_BODY, if an
 * argument is not valid or there is no memory. */
orchard_shape orchard_detector_add_tree(orchard_detector* detector, const orchard_tree* tree);
/* Loads a tree that the detector owns. Unless `error` is null, it receives a sentence if there is no tree, otherwise
 * null. */
orchard_shape orchard_detector_load(orchard_detector* detector, const char* path, const char** error);
orchard_shape orchard_detector_add_sphere(orchard_detector* detector, double radius, const double center[3]);
orchard_shape orchard_detector_add_capsule(orchard_detector* detector, const double p[3], const double q[3],
                                           double radius);
orchard_shape orchard_detector_add_box(orchard_detector* detector, const double half_lengths[3]);
orchard_body orchard_detector_add_body(orchard_detector* detector, const orchard_part* parts, size_t count,
                                       const orchard_body_options* options);
orchard_body orchard_detector_add_static(orchard_detector* detector, const orchard_part* parts, size_t count,
                                         const orchard_pose* pose, const orchard_body_options* options);
/* The index of the half-space that is added first. Further ones have the following indices, and none is reused.
 * Indices of all other bodies are smaller. */
#define ORCHARD_FIRST_HALF_SPACE 0xf0000000u
orchard_body orchard_detector_add_half_space(orchard_detector* detector, const double normal[3], double offset,
                                             const orchard_body_options* options);

/* These functions return 1; or 0, and change nothing. */
int orchard_detector_remove(orchard_detector* detector, orchard_body body);
int orchard_detector_cancel(orchard_detector* detector, orchard_body body);
int orchard_detector_teleport(orchard_detector* detector, orchard_body body);
int orchard_detector_move_static(orchard_detector* detector, orchard_body body, const orchard_pose* pose);
int orchard_detector_set_local(orchard_detector* detector, orchard_body body, size_t part, const orchard_pose* local);
int orchard_detector_set_importance(orchard_detector* detector, orchard_body body, uint8_t importance);
/* A null filter is the default one. */
int orchard_detector_set_filter(orchard_detector* detector, orchard_body body, const orchard_body_filter* filter);
/* For detectors without a source: from the time of the last step on, the body has this state and moves straight. */
int orchard_detector_set_state(orchard_detector* detector, orchard_body body, const orchard_body_state* state);
int orchard_detector_set_velocity(orchard_detector* detector, orchard_body body, const double velocity[3]);
int orchard_detector_sleep(orchard_detector* detector, orchard_body body);
int orchard_detector_wake(orchard_detector* detector, orchard_body body);
int orchard_detector_set_pair_filter(orchard_detector* detector, orchard_pair_filter filter,
                                     void* context); /* May be null. */
size_t orchard_detector_size(const orchard_detector* detector);
/* Returns the state at the last step if there is no source, otherwise the state that the source gave last. Static
 * bodies are at rest. */
orchard_body_state orchard_detector_state(const orchard_detector* detector, orchard_body body);
int orchard_detector_moves(const orchard_detector* detector, orchard_body body); /* Neither static nor a half-space. */

orchard_frame orchard_detector_step(orchard_detector* detector, double time, orchard_budget budget);
/* Answers only the last step up to `time`; use it after a pause. */
orchard_frame orchard_detector_step_latest(orchard_detector* detector, double time, orchard_budget budget);
/* Returns an event of the last step; index < events. */
orchard_pair_event orchard_detector_event(const orchard_detector* detector, size_t index);
/* Returns up to four points at which the bodies of an event touch, and the translation that separates them: see
 * Detector::manifold. It has no points and the answer "maybe" if the event's answer is not yes or its bodies do not
 * exist any more. */
orchard_manifold orchard_detector_manifold(orchard_detector* detector, size_t index);
/* Queries about all bodies at the last step: see Detector::cast_ray. They return 1, or 0 if nothing is found. A null
 * filter includes all bodies. */
typedef struct orchard_world_point {
  orchard_body body;
  uint32_t part;
  double distance; /* Along a ray, in multiples of its direction's length. */
  double point[3];
  uint32_t triangle; /* ORCHARD_NO_TRIANGLE unless the shape is a tree. */
} orchard_world_point;
int orchard_detector_cast_ray(orchard_detector* detector, const double origin[3], const double direction[3],
                              double longest, const orchard_query_filter* filter, orchard_world_point* found);
int orchard_detector_nearest(orchard_detector* detector, const double point[3], double limit,
                             const orchard_query_filter* filter, orchard_world_point* found);
/* Returns how many bodies a solid sphere touches, and stores the first `room` of them, in ascending order of indices.
 */
size_t orchard_detector_touching_sphere(orchard_detector* detector, const double center[3], double radius,
                                        const orchard_query_filter* filter, orchard_body* bodies, size_t room);
uint32_t orchard_detector_refused(const orchard_detector* detector, size_t index);
uint32_t orchard_detector_broken(const orchard_detector* detector, size_t index);
uint64_t orchard_detector_motion_bound_violations(const orchard_detector* detector);
/* The predicted cost of a step: at least these motions, and the expected numbers of pairs and of units of work. */
typedef struct orchard_step_load {
  double time;
  uint64_t motions;
  double pairs, work;
} orchard_step_load;
/* Predicts the cost of the next `count` steps, and returns how many steps are known. */
size_t orchard_detector_predict_load(const orchard_detector* detector, orchard_step_load* loads, size_t count);

#ifdef __cplusplus
}
#endif

#endif
