/* The same in C: two copies of a body approach each other; the answer after at most a million tests, and the distance.
 *   approach_c body.orchard */
#include <stdio.h>

#include "orchard/runtime/orchard.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    fprintf(stderr, "usage: approach_c body.orchard\n");
    return 2;
  }
  const char* error = NULL;
  orchard_tree* body = orchard_tree_open(argv[1], &error);
  if (body == NULL) {
    fprintf(stderr, "%s: %s\n", argv[1], error);
    return 2;
  }
  orchard_pair* pair = orchard_pair_new(body, body);
  if (pair == NULL) {
    fprintf(stderr, "out of memory\n");
    orchard_tree_close(body);
    return 1;
  }
  static const char* const names[] = {"no", "maybe", "yes"};
  const orchard_budget budget = {1000000, ORCHARD_NO_LIMIT};
  const orchard_pose still = orchard_identity();
  const double turned[4] = {0.9238795325112867, 0, 0, 0.3826834323650898}, nowhere[3] = {0, 0, 0}; /* 45 degrees, z */
  orchard_pose moving;
  if (!orchard_pose_from_quaternion(turned, nowhere, &moving)) return 1;
  printf("orchard %s\n", orchard_version());
  for (int step = 0; step <= 10; ++step) {
    moving.translation[0] = (2.5 - 0.25 * step) * orchard_tree_bounding_radius(body);
    const orchard_verdict verdict = orchard_collide(pair, &still, &moving, budget);
    const orchard_distance distance = orchard_measure(pair, &still, &moving, 0.01);
    printf("%2d: %s; at least %.3g and at most %.3g apart\n", step, names[verdict.answer], distance.lower,
           distance.upper);
    if (verdict.answer == ORCHARD_YES) break;
  }
  orchard_pair_free(pair);
  orchard_tree_close(body);
  return 0;
}
