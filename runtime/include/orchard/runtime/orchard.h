/* The run-time for programs in C and for languages that call C. A thin cover of the C++ headers beside it, which say
 * more: tree_file.h, narrow_phase.h, collide.h, distance.h, shape_query.h, contacts.h, time_of_impact.h, packed_tree.h,
 * self_collision.h. Many bodies: orchard_broad_phase.h, orchard_detector.h.
 *
 * Link orchard::runtime and the C++ standard library. No function throws or exits. Pointers must not be null unless it
 * says so. Trees are only read by queries: any number of pairs in any number of threads may share one; a pair belongs
 * to one thread at a time. Trees outlive the pairs made of them. Coordinates are in the world's units. */
#ifndef ORCHARD_RUNTIME_ORCHARD_H
#define ORCHARD_RUNTIME_ORCHARD_H

#include <stddef.h>
#include <stdint.h>

#include "orchard/runtime/version.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct orchard_tree orchard_tree;
typedef struct orchard_pair orchard_pair;
typedef struct orchard_workspace orchard_workspace;

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

/* ORCHARD_VERSION_STRING of the library that is linked, which a shared one may have newer than the headers. Lives as
 * long as the program. */
const char* orchard_version(void);

orchard_pose orchard_identity(void);
int orchard_is_rigid(const orchard_pose* pose); /* 1 if queries can answer for it, or 0 */
/* The nearest rotation to one that rounding has spoilt, by at most 1e-3. 1, or 0 and nothing is changed. */
int orchard_make_rigid(orchard_pose* pose);
/* The same from floats, row-major: 1 and the pose, or 0 and nothing is changed. */
int orchard_pose_from_matrix(const float rotation[9], const float translation[3], float scale, orchard_pose* pose);

/* From a quaternion, the real part first (w, x, y, z), of any length: 1 and the pose, with the scale 1; or 0 and
 * nothing is changed, if the quaternion is zero or anything is not finite. */
int orchard_pose_from_quaternion(const double wxyz[4], const double translation[3], orchard_pose* pose);

/* Null if it fails; `error`, unless null, then gets a sentence that lives as long as the program.
 * open() uses the file in place: its pages are shared between processes, and it must stay as it is until the tree is
 * closed. If it is cut short meanwhile, the program receives SIGBUS at the next query; if it is written to,
 * queries may leave their arrays. Replacing it by renaming another file over it is safe. Where others may write to
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

/* The whole question at once, the triangles first, as far as the budget goes. orchard_start() and orchard_refine() go
 * level by level. */
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

/* From now on rays against this tree take about half of their time, for some 60 bytes a triangle: 1, or 0 and nothing
 * is changed if there is no memory. Answers stay the same. No other thread may ask about the tree meanwhile. */
int orchard_index_rays(orchard_tree* tree);

/* The point of the surface nearest to `center`, if it is within `limit`: 1, 0, or -1 as above. Null: not wanted. */
int orchard_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3], double limit,
                          double* distance, double point[3], uint32_t* triangle);
/* The same with a sign, negative inside the solid, and the direction in which the distance grows. */
int orchard_signed_nearest_point(const orchard_tree* tree, const orchard_pose* pose, const double center[3],
                                 double limit, double* distance, double point[3], double normal[3], uint32_t* triangle);
/* Whether a convex solid, its inside included, touches the surface: a box around its pose's origin of half the edges'
 * lengths `half`; or corners, three numbers each, and triangles outward around it, three corners each. */
int orchard_box_touches(const orchard_tree* tree, const orchard_pose* pose, const double half[3],
                        const orchard_pose* box);
int orchard_hull_touches(const orchard_tree* tree, const orchard_pose* pose, const double* corners, size_t corner_count,
                         const uint32_t* facets, size_t facet_count, const orchard_pose* hull);
/* The signed distance of the surface's deepest point from the plane normal . x = offset, negative below it; minus
 * infinity where nothing can be said. The half-space below touches the surface if it is not positive. */
double orchard_plane_distance(const orchard_tree* tree, const orchard_pose* pose, const double normal[3],
                              double offset);

/* Trees of shapes, for queries between trees: closed like others. Null if there is no memory, or, for a hull, if the
 * points, three numbers each, lie in a plane. A sphere or capsule is a point or segment with a margin. */
orchard_tree* orchard_point_tree(const double point[3]);
orchard_tree* orchard_segment_tree(const double p[3], const double q[3]);
orchard_tree* orchard_box_tree(const double half[3]);
orchard_tree* orchard_hull_tree(const double* points, size_t count);

/* What queries between trees need while they run, one per thread; the trees themselves are what persists. Null if there
 * is no memory. */
orchard_workspace* orchard_workspace_new(void);
void orchard_workspace_free(orchard_workspace* workspace); /* null is fine */

/* Whether the surfaces are within `margin` of each other: 1 yes, 0 no, -1 not known. */
int orchard_closer_than(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                        const orchard_tree* b, const orchard_pose* pose_b, double margin);

/* The same with witnesses, for 1: a point of each surface, at most `margin` apart. */
int orchard_closer_with_points(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                               const orchard_tree* b, const orchard_pose* pose_b, double margin,
                               orchard_distance* distance);

typedef struct orchard_manifold {
  orchard_answer answer;
  uint32_t count; /* of points */
  double points[4][3];
  uint32_t triangles[4][2]; /* of a and b, for each point */
  double normal[3];         /* from a to b */
  double depth;             /* b moved so far along it touches a no more */
  double error;             /* maybe: the radius of a ball around the only point, which is a guess */
  int complete;
  double depths[4]; /* of each point: how far b moves along the normal until its two triangles are apart */
} orchard_manifold;
orchard_manifold orchard_contacts(orchard_workspace* workspace, const orchard_tree* a, const orchard_pose* pose_a,
                                  const orchard_tree* b, const orchard_pose* pose_b);
/* The same, and surfaces at most `margin` apart have a point before they touch: the answer is "no" then, and the depth
 * minus the distance. */
orchard_manifold orchard_contacts_within(orchard_workspace* workspace, const orchard_tree* a,
                                         const orchard_pose* pose_a, const orchard_tree* b, const orchard_pose* pose_b,
                                         double margin);

typedef struct orchard_signed_distance {
  double lower, upper; /* lower <= distance <= upper; negative where the surfaces meet: minus the manifold's depth */
  double on_a[3], on_b[3];
  double normal[3]; /* the direction in which b leaves a */
} orchard_signed_distance;
/* Apart: until upper <= (1 + tolerance) * lower, but for rounding. */
orchard_signed_distance orchard_measure_signed(orchard_workspace* workspace, const orchard_tree* a,
                                               const orchard_pose* pose_a, const orchard_tree* b,
                                               const orchard_pose* pose_b, double tolerance);

/* A motion: from `start`, with `center` (in the body's coordinates) at constant velocity and the body turning about it
 * with the constant angular velocity `spin`, in the world. Unless pose_at is null: any motion; pose_at gives the pose
 * at a time, 1 if it did; between two times the centre moves at most `speed` and the body turns at most by the angle
 * `turning` a unit of time. */
typedef struct orchard_travel {
  orchard_pose start;
  double velocity[3], spin[3], center[3];
  int (*pose_at)(const void* context, double time, orchard_pose* pose);
  const void* context;
  double speed, turning;
} orchard_travel;
orchard_travel orchard_travel_between(const orchard_pose* from, const orchard_pose* to, const double center[3]);

typedef struct orchard_impact {
  orchard_answer answer; /* no: they touch at no time. yes: not before t0, and at t1. maybe: not before t0 */
  double t0, t1;
  double distance; /* at most, at t0; infinite if unknown */
  double on_a[3], on_b[3];
  uint32_t triangle_a, triangle_b;
  int finished, refused;
  uint64_t work;
} orchard_impact;
/* From time `begin` to `end`; ends where the surfaces are within margin + tolerance. */
orchard_impact orchard_time_of_impact(orchard_workspace* workspace, const orchard_tree* a,
                                      const orchard_travel* travel_a, const orchard_tree* b,
                                      const orchard_travel* travel_b, double begin, double end, double tolerance,
                                      double margin, orchard_budget budget);

/* A pair that is asked about again and again while it moves a little: yes and no as orchard_collide() without limits,
 * for less. */
orchard_verdict orchard_collide_again(orchard_pair* pair, const orchard_pose* a, const orchard_pose* b);

/* Many rays against one tree, three numbers for each origin and direction: hit[i] is 1, 0 or -1 as of
 * orchard_cast_ray(), along[i] its factor. */
void orchard_cast_rays(const orchard_tree* tree, const orchard_pose* pose, const double* origins,
                       const double* directions, double longest, size_t count, int* hit, double* along);

/* Runs job(data, i) for each i < count, in any order, on any threads, and returns when all have returned. */
typedef struct orchard_executor {
  void (*run)(void* context, size_t count, void (*job)(void* data, size_t index), void* data); /* null: here */
  void* context;
  size_t concurrency;
} orchard_executor;
/* Pair i: a[i] at poses_a[i] and b[i] at poses_b[i]. One workspace for each of the jobs that may run at once, at least
 * one. Answers do not depend on their number. */
void orchard_collide_all(orchard_workspace* const* workspaces, size_t workspace_count, const orchard_executor* executor,
                         const orchard_tree* const* a, const orchard_pose* poses_a, const orchard_tree* const* b,
                         const orchard_pose* poses_b, size_t count, orchard_verdict* verdicts);
/* The same for orchard_measure(), and for orchard_closer_than() with one margin: closer[i] is 1, 0 or -1. */
void orchard_measure_all(orchard_workspace* const* workspaces, size_t workspace_count, const orchard_executor* executor,
                         const orchard_tree* const* a, const orchard_pose* poses_a, const orchard_tree* const* b,
                         const orchard_pose* poses_b, size_t count, double tolerance, orchard_distance* distances);
void orchard_closer_than_all(orchard_workspace* const* workspaces, size_t workspace_count,
                             const orchard_executor* executor, const orchard_tree* const* a,
                             const orchard_pose* poses_a, const orchard_tree* const* b, const orchard_pose* poses_b,
                             size_t count, double margin, int* closer);

/* Does a robot touch itself, or what stands around it? Parts 0 .. count - 1, a tree each; pairs that may touch are not
 * asked about: none at first. Belongs to one thread at a time; queries allocate nothing. Null if there is no memory. */
typedef struct orchard_self_collision orchard_self_collision;
orchard_self_collision* orchard_self_collision_new(const orchard_tree* const* parts, size_t count);
void orchard_self_collision_free(orchard_self_collision* self); /* null is fine */
/* Whether two parts may touch from now on: 1, or 0 and nothing is changed if there is no such part. */
int orchard_self_collision_allow(orchard_self_collision* self, size_t a, size_t b, int allowed);
/* Allows the pairs that touch, or might, where the parts are now: those that always do at rest. `poses`, here and
 * below: one for every part. */
void orchard_self_collision_allow_touching(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses);

typedef struct orchard_touch {
  orchard_answer answer; /* yes: these parts touch; maybe: nothing is known of them; no: there is no such pair */
  size_t part_a, part_b;
  double contact_center[3], contact_radius, contact_normal[3];
  uint32_t triangle_a, triangle_b; /* ORCHARD_NO_TRIANGLE unless the answer is yes */
} orchard_touch;
/* The first pair of parts, in order, that touch though they may not; without one, the first of which nothing is known.
 */
orchard_touch orchard_self_collision_first(orchard_self_collision* self, orchard_workspace* workspace,
                                           const orchard_pose* poses);
/* All of these, in order: their number, and as many of them as there is room for. */
size_t orchard_self_collision_all(orchard_self_collision* self, orchard_workspace* workspace, const orchard_pose* poses,
                                  orchard_touch* touches, size_t room);

#ifdef __cplusplus
}
#endif

#endif
