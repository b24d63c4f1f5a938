/* The run-time for programs in C and for languages that call C. A thin cover of the C++ headers beside it, which say
 * more: tree_file.h, narrow_phase.h, collide.h, distance.h, shape_query.h.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits. Pointers must not be null unless it
 * says so. Trees are only read by queries: any number of pairs in any number of threads may share one; a pair belongs
 * to one thread at a time. Trees outlive the pairs made of them. Coordinates are in the world's units. */
#ifndef ORCHARD_RUNTIME_ORCHARD_H
#define ORCHARD_RUNTIME_ORCHARD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct orchard_tree orchard_tree;
typedef struct orchard_pair orchard_pair;

/* world = scale * rotation * body + translation; rotation row-major, a proper rotation to 1e-12; 1e-100 <= scale <=
 * 1e100. Of a pose that is not so (zeros from memset, a mirror, shear, what is not a number, a rotation of floats)
 * every query says that nothing is known: maybe, finished and refused, with the bounds 0 and infinity; or -1. No query
 * crashes or says no. */
typedef struct orchard_pose {
  double rotation[9];
  double translation[3];
  double scale;
} orchard_pose;

typedef enum orchard_answer {
  ORCHARD_NO = 0,    /* the surfaces do not touch: certain */
  ORCHARD_MAYBE = 1, /* so far nothing excludes it */
  ORCHARD_YES = 2    /* a triangle of one meets a triangle of the other */
} orchard_answer;

#define ORCHARD_NO_TRIANGLE 0xffffffffu
#define ORCHARD_NO_LIMIT UINT64_MAX

typedef struct orchard_budget {
  uint64_t tests;       /* pair tests, or ORCHARD_NO_LIMIT */
  uint64_t nanoseconds; /* or ORCHARD_NO_LIMIT */
} orchard_budget;

typedef struct orchard_verdict {
  orchard_answer answer;
  double separation_bound; /* the solids are no farther apart; may be infinite */
  double lower_bound;      /* the surfaces are no nearer; 0 if nothing is known */
  double contact_center[3], contact_radius, contact_normal[3];
  uint32_t triangle_a, triangle_b; /* ORCHARD_NO_TRIANGLE unless the answer is yes */
  uint32_t level;
  int finished;  /* refining changes nothing any more */
  int refused;   /* the poses are not rigid, or too far apart or too different in scale to be asked about */
  uint64_t work; /* tests since the start: given as a budget, it repeats a run that time cut short */
} orchard_verdict;

typedef struct orchard_distance {
  double lower, upper; /* lower <= distance of the surfaces <= upper */
  double on_a[3], on_b[3];
  uint32_t triangle_a, triangle_b;
} orchard_distance;

orchard_pose orchard_identity(void);
int orchard_is_rigid(const orchard_pose* pose); /* 1 if queries can answer for it, or 0 */
/* The nearest rotation to one that rounding has spoilt, by at most 1e-3. 1, or 0 and nothing is changed. */
int orchard_make_rigid(orchard_pose* pose);
/* The same from floats, row-major: 1 and the pose, or 0 and nothing is changed. */
int orchard_pose_from_matrix(const float rotation[9], const float translation[3], float scale, orchard_pose* pose);

/* Null if it fails; `error`, unless null, then gets a sentence that lives as long as the program.
 * open() uses the file in place: its pages are shared between processes, and it must stay as it is until the tree is
 * closed. Whoever cuts it short meanwhile makes the program receive SIGBUS at the next query; whoever writes into it
 * makes queries leave their arrays. Replacing it by renaming another file over it is safe. Where others may write to
 * files, read() copies it into memory; load() does so with bytes. */
orchard_tree* orchard_tree_open(const char* path, const char** error);
orchard_tree* orchard_tree_read(const char* path, const char** error);
orchard_tree* orchard_tree_load(const void* bytes, size_t size,
                                const char** error); /* null bytes are fine if size is 0 */
void orchard_tree_close(orchard_tree* tree);         /* null is fine */
double orchard_tree_bounding_radius(const orchard_tree* tree);
size_t orchard_tree_triangles(const orchard_tree* tree);

/* Null if there is no memory. Once per pair of bodies: queries reuse it and allocate nothing. */
orchard_pair* orchard_pair_new(const orchard_tree* a, const orchard_tree* b);
void orchard_pair_free(orchard_pair* pair); /* null is fine */

/* The whole question at once: without limits straight to yes or no, with one level by level as far as it goes. */
orchard_verdict orchard_collide(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b,
                                orchard_budget budget);
/* The same in steps: each refines to the end of the next level or of the budget. */
orchard_verdict orchard_start(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b);
orchard_verdict orchard_refine(orchard_pair* pair, orchard_budget budget);
/* Until upper <= (1 + tolerance) * lower, but for rounding. */
orchard_distance orchard_measure(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b, double tolerance);

/* Against one tree. 1 for yes, 0 for no, -1 where nothing can be said (see orchard_pose; also for numbers that are not
 * finite): a test for anything but 0 misses nothing. A capsule is the points within `radius` of the segment from p to
 * q. */
int orchard_capsule_touches(const orchard_tree* tree, const orchard_pose* pose, const double p[3], const double q[3],
                            double radius);
int orchard_contains(const orchard_tree* tree, const orchard_pose* pose, const double point[3]);
/* 1 and the factor of `direction` at the first hit up to `longest`, or 0; -1 as above, with the factor 0. */
int orchard_cast_ray(const orchard_tree* tree, const orchard_pose* pose, const double origin[3],
                     const double direction[3], double longest, double* along);

#ifdef __cplusplus
}
#endif

#endif
