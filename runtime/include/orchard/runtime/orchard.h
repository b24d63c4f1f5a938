/* The run-time for programs in C and for languages that call C. It is a thin layer over the C++ headers in this
 * folder, which describe the functions in detail: tree_file.h, narrow_phase.h, collide.h, distance.h, shape_query.h,
 * contacts.h, time_of_impact.h, packed_tree.h, self_collision.h. For many bodies, see orchard_broad_phase.h and
 * orchard_detector.h.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits. Pointers must not be null unless
 * the function allows it. Queries only read trees, so any number of pairs in any number of threads may share one; a
 * pair belongs to one thread at a time. Trees must outlive the pairs that use them. Coordinates are in the world's
 * units. */
#ifndef ORCHARD_RUNTIME_ORCHARD_H
#define ORCHARD_RUNTIME_ORCHARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "orchard/runtime/version.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct orchard_tree orchard_tree;
typedef struct orchard_pair orchard_pair;
typedef struct orchard_workspace orchard_workspace;

/* The place of a body: world = scale * rotation * body + translation. The rotation is row-major, a proper rotation to
 * 1e-12, and 1e-100 <= scale <= 1e100. For any other pose (zeros from memset, a mirror, shear, NaN, a rotation of
 * floats), every query returns that nothing is known: "maybe", finished and refused, with the bounds 0 and infinity;
 * or -1. No query crashes or answers "no". */
typedef struct orchard_pose {
  double rotation[9];
  double translation[3];
  double scale;
} orchard_pose;

enum {
  ORCHARD_NO = 0,    /* The surfaces do not touch; this is certain. */
  ORCHARD_MAYBE = 1, /* Nothing excludes a contact so far. */
  ORCHARD_YES = 2    /* A triangle of one body meets a triangle of the other. */
};
typedef uint8_t orchard_answer; /* One of these. */

#define ORCHARD_NO_TRIANGLE 0xffffffffu
#define ORCHARD_NO_LIMIT UINT64_MAX

typedef struct orchard_budget {
  uint64_t tests;       /* Pair tests, or ORCHARD_NO_LIMIT. */
  uint64_t nanoseconds; /* Or ORCHARD_NO_LIMIT. */
} orchard_budget;

typedef struct orchard_verdict {
  orchard_answer answer;
  double separation_bound; /* The solids are at most this far apart; may be infinite. */
  double lower_bound;      /* The surfaces are at least this far apart; 0 if nothing is known. */
  double contact_center[3], contact_radius, contact_normal[3];
  uint32_t triangle_a, triangle_b; /* ORCHARD_NO_TRIANGLE unless the answer is yes. */
  uint32_t level;
  uint64_t work; /* Tests since the start; as a budget, this number repeats a run that time cut short. */
  bool finished; /* Refining changes nothing any more. */
  bool refused;  /* The poses are not rigid, or too far apart or too different in scale to be answered. */
} orchard_verdict;

typedef struct orchard_distance {
  double lower, upper; /* lower <= distance of the surfaces <= upper. */
  double on_a[3], on_b[3];
  uint32_t triangle_a, triangle_b;
} orchard_distance;

/* An executor: `run` calls job(data, i) for each i < count, in any order, on any threads, and returns when all calls
 * have returned. */
typedef struct orchard_executor {
  void (*run)(void* context, size_t count, void (*job)(void* data, size_t index), void* data); /* Null: serial. */
  void* context;
  size_t concurrency;
} orchard_executor;

/* Returns ORCHARD_VERSION_STRING of the linked library; a shared library may be newer than the headers. The string
 * lives as long as the program. */
const char* orchard_version(void);

orchard_pose orchard_identity(void);
int orchard_is_rigid(const orchard_pose* pose); /* Returns 1 if queries can answer for the pose, otherwise 0. */
/* Replaces a rotation that rounding has changed, by at most 1e-3, by the nearest proper rotation. Returns 1; or 0, and
 * changes nothing. */
int orchard_make_rigid(orchard_pose* pose);
/* Stores the same for a row-major rotation of floats. Returns 1; or 0, and changes nothing. */
int orchard_pose_from_matrix(const float rotation[9], const float translation[3], float scale, orchard_pose* pose);

/* Stores the pose of a quaternion of any length, the real part first (w, x, y, z), with the scale 1. Returns 1; or 0,
 * and changes nothing, if the quaternion is zero or a number is not finite. */
int orchard_pose_from_quaternion(const double wxyz[4], const double translation[3], orchard_pose* pose);

/* These functions return null if they fail. Unless `error` is null, it then receives a sentence that lives as long as
 * the program.
 * open() uses the file in place: its pages are shared between processes, and it must not change until the tree is
 * closed. If the file is truncated meanwhile, the program receives SIGBUS at the next query; if it is written to,
 * queries may leave their arrays. Replacing it by renaming another file over it is safe. If other programs may write
 * to the file, use read(), which copies it into memory; load() does the same with bytes. */
orchard_tree* orchard_tree_open(const char* path, const char** error);
orchard_tree* orchard_tree_read(const char* path, const char** error);
orchard_tree* orchard_tree_load(const void* bytes, size_t size,
                                const char** error); /* `bytes` may be null if size is 0. */
void orchard_tree_close(orchard_tree* tree);         /* The tree may be null. */
double orchard_tree_bounding_radius(const orchard_tree* tree);
size_t orchard_tree_triangles(const orchard_tree* tree);

/* Returns null if there is no memory. Create one object for each pair of bodies: queries reuse it and allocate
 * nothing. */
orchard_pair* orchard_pair_new(const orchard_tree* a, const orchard_tree* b);
void orchard_pair_free(orchard_pair* pair); /* The pair may be null. */

/* Answers the whole question within the budget, the triangles first. orchard_start() and orchard_refine() go level by
 * level. */
orchard_verdict orchard_collide(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b,
                                orchard_budget budget);
/* Answers the same in steps: each call refines to the end of the next level or of the budget. */
orchard_verdict orchard_start(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b);
orchard_verdict orchard_refine(orchard_pair* pair, orchard_budget budget);
/* Measures the distance until upper <= (1 + tolerance) * lower, up to rounding. */
orchard_distance orchard_measure(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b, double tolerance);

/* Queries against one tree. They return 1 for yes, 0 for no, and -1 if the query cannot be answered (see orchard_pose;
 * also for numbers that are not finite), so a test for anything but 0 misses nothing. A capsule consists of the points
 * within `radius` of the segment from p to q. */
int orchard_capsule_touches(const orchard_tree* tree, const orchard_pose* pose, const double p[3], const double q[3],
                            double radius);
int orchard_contains(const orchard_tree* tree, const orchard_pose* pose, const double point[3]);
/* Returns 1 and the factor of `direction` at the first hit up to `longest`; 0 without a hit; or -1 as above, with the
 * factor 0. */
int orchard_cast_ray(const orchard_tree* tree, const orchard_pose* pose, const double origin[3],
                     const double direction[3], double longest, double* along);

/* Builds an index of the tree, with which rays take about half of their time, for about 65 bytes a triangle. Answers
 * stay the same. Returns 1; or 0, and changes nothing, if there is no memory. No other thread may query the tree
 * meanwhile. */
int orchard_index_rays(orchard_tree* tree);

/* Returns 1 and the point of the surface that is nearest to `center` if it is within `limit`; 0 if there is none; or
 * -1 as above. Results whose pointer is null are not stored. */
int orchard_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3], double limit,
                          double* distance, double point[3], uint32_t* triangle);
/* Does the same with a sign, negative inside the solid, and also stores the direction in which the distance grows. */
int orchard_signed_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3],
                                 double limit, double* distance, double point[3], double normal[3], uint32_t* triangle);
/* These functions return whether a convex solid, its inside included, touches the surface. A box lies around its
 * pose's origin, with half the edges' lengths `half`. A hull consists of corners, three numbers each, and triangles
 * oriented outward around it, three corners each. */
int orchard_box_touches(const orchard_tree* tree, const orchard_pose* pose, const double half[3],
                        const orchard_pose* box);
int orchard_hull_touches(const orchard_tree* tree, const orchard_pose* pose, const double* corners, size_t corner_count,
                         const uint32_t* facets, size_t facet_count, const orchard_pose* hull);
/* Returns the signed distance of the surface's deepest point from the plane normal . x = offset, negative below it;
 * minus infinity if the query cannot be answered. The half-space below touches the surface if the result is not
 * positive. */
double orchard_plane_distance(const orchard_tree* tree, const orchard_pose* pose, const double normal[3],
                              double offset);

/* These functions build trees of shapes, for queries between trees; close them like others. They return null if there
 * is no memory or, for a hull, if the points, three numbers each, lie in a plane. A sphere or capsule is a point or
 * segment with a margin. */
orchard_tree* orchard_point_tree(const double point[3]);
orchard_tree* orchard_segment_tree(const double p[3], const double q[3]);
orchard_tree* orchard_box_tree(const double half[3]);
orchard_tree* orchard_hull_tree(const double* points, size_t count);

/* Allocates the memory of queries between trees, one workspace per thread. Returns null if there is no memory. */
orchard_workspace* orchard_workspace_new(void);
void orchard_workspace_free(orchard_workspace* workspace); /* The workspace may be null. */

/* Returns whether the surfaces are within `margin` of each other: 1 yes, 0 no, -1 not known. Unless `points` is null,
 * it receives for 1 a point of each surface, at most `margin` apart, which costs a distance query. */
int orchard_closer_than(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                        const orchard_tree* b, const orchard_pose* pose_b, double margin, orchard_distance* points);

typedef struct orchard_contact_point {
  double place[3];
  uint32_t triangle_a, triangle_b;
  double depth; /* How far b moves along the normal until these two triangles are apart. */
} orchard_contact_point;
typedef struct orchard_manifold {
  orchard_answer answer;
  uint32_t count; /* The number of points. */
  orchard_contact_point points[4];
  double normal[3]; /* The unit vector from a to b. */
  double depth;     /* After moving b by this along the normal, it does not touch a any more. */
  double error;     /* For maybe: the radius of a ball around the only point, which is a guess. */
  bool complete;
} orchard_manifold;
/* Returns where two bodies touch. Surfaces that do not touch and are at most `margin` apart, if it is above 0, have a
 * point, too: the answer is then "no", and the depth is minus the distance. */
orchard_manifold orchard_contacts(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                                  const orchard_tree* b, const orchard_pose* pose_b, double margin);

typedef struct orchard_signed_distance {
  double lower, upper; /* lower <= distance <= upper; minus the manifold's depth where the surfaces meet. */
  double on_a[3], on_b[3];
  double normal[3]; /* The direction in which b leaves a. */
} orchard_signed_distance;
/* Measures the signed distance. For surfaces that are apart, until upper <= (1 + tolerance) * lower, up to rounding. */
orchard_signed_distance orchard_measure_signed(orchard_workspace* workspace, const orchard_tree* a,
                                               const orchard_pose* pose_a, const orchard_tree* b,
                                               const orchard_pose* pose_b, double tolerance);

/* The motion of a body: from `start`, `center` (in the body's coordinates) moves at constant velocity, and the body
 * turns about it at the constant angular velocity `spin`, in the world. If pose_at is not null, the motion may be any:
 * pose_at stores the pose at a time and returns 1 if it did. Between two times, the centre moves by at most `speed`
 * and the body turns by at most the angle `turning` in a unit of time. */
typedef struct orchard_travel {
  orchard_pose start;
  double velocity[3], spin[3], center[3];
  int (*pose_at)(const void* context, double time, orchard_pose* pose);
  const void* context;
  double speed, turning;
} orchard_travel;
orchard_travel orchard_travel_between(const orchard_pose* from, const orchard_pose* to, const double center[3]);

typedef struct orchard_impact {
  orchard_answer answer; /* no: no contact at any time. yes: none before t0, contact at t1. maybe: none before t0. */
  double t0, t1;
  double distance; /* An upper bound at t0; infinite if unknown. */
  double on_a[3], on_b[3];
  uint32_t triangle_a, triangle_b;
  uint32_t steps; /* In which the time advanced. */
  bool finished, refused;
  uint64_t work;
} orchard_impact;
/* Finds the first contact from time `begin` to `end`. The search ends if the surfaces are within margin + tolerance. */
orchard_impact orchard_time_of_impact(orchard_workspace* workspace, const orchard_tree* a,
                                      const orchard_travel* travel_a, const orchard_tree* b,
                                      const orchard_travel* travel_b, double begin, double end, double tolerance,
                                      double margin, orchard_budget budget);

/* Answers a pair that is queried repeatedly while it moves a little each time. "Yes" and "no" are those of
 * orchard_collide() without limits, at less cost. */
orchard_verdict orchard_collide_again(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b);

/* Casts many rays against one tree, with three numbers for each origin and direction. hit[i] is 1, 0 or -1 as for
 * orchard_cast_ray(), and along[i] its factor. */
void orchard_cast_rays(const orchard_tree* tree, const orchard_pose* pose, const double* origins,
                       const double* directions, double longest, size_t count, int* hit, double* along);

/* Many pairs: pair i is a[i] at poses_a[i] and b[i] at poses_b[i]. There is one workspace for each job that may run at
 * once, at least one. Answers do not depend on their number. The executor may be null: one pair after the other. */
typedef struct orchard_batch {
  const orchard_tree* const* a;
  const orchard_pose* poses_a;
  const orchard_tree* const* b;
  const orchard_pose* poses_b;
  size_t count;
  orchard_workspace* const* workspaces;
  size_t workspace_count;
  const orchard_executor* executor;
} orchard_batch;
/* These functions answer all pairs as orchard_collide() without limits, orchard_measure() and orchard_closer_than() do:
 * closer[i] is 1, 0 or -1. */
void orchard_collide_all(const orchard_batch* batch, orchard_verdict* verdicts);
void orchard_measure_all(const orchard_batch* batch, double tolerance, orchard_distance* distances);
void orchard_closer_than_all(const orchard_batch* batch, double margin, int* closer);

/* Finds whether a robot touches itself or its surroundings. Parts 0 .. count - 1 have a tree each. Pairs that may
 * touch are not tested; at first there are none. An object belongs to one thread at a time; queries allocate nothing.
 * Returns null if there is no memory. */
typedef struct orchard_self_collision orchard_self_collision;
orchard_self_collision* orchard_self_collision_new(const orchard_tree* const* parts, size_t count);
void orchard_self_collision_free(orchard_self_collision* self); /* The object may be null. */
/* Sets whether two parts may touch. Returns 1; or 0, and changes nothing, if there is no such part. */
int orchard_self_collision_allow(orchard_self_collision* self, size_t a, size_t b, int allowed);
/* Allows all pairs that touch or might touch at the given poses, which are those that always touch at rest. Here and
 * below, `poses` has an element for every part. */
void orchard_self_collision_allow_touching(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses);

typedef struct orchard_touch {
  orchard_answer answer; /* yes: these parts touch. maybe: nothing is known of them. no: there is no such pair. */
  size_t part_a, part_b;
  double contact_center[3], contact_radius, contact_normal[3];
  uint32_t triangle_a, triangle_b; /* ORCHARD_NO_TRIANGLE unless the answer is yes. */
} orchard_touch;
/* Returns the first pair of parts, in order, that touch without being allowed to; without one, the first undecided
 * pair. */
orchard_touch orchard_self_collision_first(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses);
/* Returns the number of these pairs, and stores the first `room` of them in order. */
size_t orchard_self_collision_all(orchard_self_collision* self, orchard_workspace* workspace, const orchard_pose* poses,
                                  orchard_touch* touches, size_t room);

#ifdef __cplusplus
}
#endif

#endif
