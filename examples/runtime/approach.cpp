// Lets two copies of a body approach each other and asks at every step whether they touch, at most 50,000 sphere tests
// a step:  approach body.orchard
#include <cstdio>

#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"

using namespace orchard::runtime;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: approach body.orchard\n");
    return 2;
  }
  PackedSphereTree tree;
  if (const LoadStatus status = load_file(argv[1], tree); status != LoadStatus::ok) {
    std::fprintf(stderr, "%s: %s\n", argv[1], message(status));
    return 2;
  }
  std::printf("%u spheres on %u levels, %zu triangles\n", tree.node_count, tree.depth + 1, tree.triangles.size());

  const PreparedTree body(tree);  // once per tree
  NarrowPhase query(body, body);  // once per pair of bodies: later queries reuse its memory
  const double radius = tree.bounding_radius;
  for (int step = 0; step <= 25; ++step) {
    const Pose still;
    const auto turned = pose_from_quaternion({1, 0.3, 0, 0}, {(2.5 - 0.1 * step) * radius, 0, 0});
    query.start(still, *turned);
    for (std::uint64_t left = 50'000; left > 0 && !query.finished();) {
      const std::uint64_t before = query.progress().pair_tests;
      query.refine({.work = left});  // to the next level, or until the budget is spent
      const std::uint64_t spent = query.progress().pair_tests - before;
      left -= spent < left ? spent : left;
    }
    switch (query.answer()) {
      case Answer::no:
        std::printf("%2d: no (%.3g apart or more)\n", step, query.lower_bound());
        break;
      case Answer::maybe:
        std::printf("%2d: maybe, at most %.3g apart after level %u\n", step, query.separation_bound(),
                    query.progress().level);
        break;
      case Answer::yes: {
        const Contact contact = query.contact();
        std::printf("%2d: yes, triangle %u meets triangle %u at (%.3g, %.3g, %.3g)\n", step, contact.triangle_a,
                    contact.triangle_b, contact.center[0], contact.center[1], contact.center[2]);
        return 0;
      }
    }
  }
  return 0;
}
