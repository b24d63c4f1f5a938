// A game loop: bodies bounce off each other and off the walls of a box, within a fixed amount of work per frame.
#include <cstdio>

#include "orchard/runtime/detector.h"
using namespace orchard::runtime;

int main(int argc, char** argv) {
  Detector world({.time_step = 0.02});
  const ShapeId hull = world.load_shape(argc == 2 ? argv[1] : "");
  if (hull == kNoShape) return std::puts("usage: game_loop body.orchard"), 2;
  const double size = world.reach(hull);
  for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
    world.add_half_space(way, -7 * size), world.add_half_space(-1.0 * way, -7 * size);
  for (int i = 0; i < 27; ++i) {
    const Vec3 place{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0}, way{i % 5 - 2.0, i % 7 - 3.0, i % 4 - 1.5};
    world.add_body(hull, {.pose = {.translation = 3.5 * size * place}, .velocity = size * way});
  }
  for (int frame = 0; frame < 500; ++frame) {
    for (const PairEvent& event : world.step(0.02 * frame, {.work = 20'000}).events) {
      if (event.change == PairChange::end || event.verdict.separation_bound > 0.05 * size) continue;
      const Vec3 a = world.state(event.a).velocity, b = world.state(event.b).velocity;
      const Vec3 normal = event.verdict.contact.normal;
      const double approach = dot(a - b, normal);
      if (approach <= 0) continue;  // on their way apart already
      world.set_velocity(event.a, a - (world.moves(event.b) ? 1 : 2) * approach * normal);
      world.set_velocity(event.b, b + approach * normal);  // a wall takes no notice
      std::printf("%.2f s: %u bounces off %u\n", event.time, event.a.index, event.b.index);
    }
  }
}
