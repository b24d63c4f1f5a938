// A game loop: bodies bounce off each other and off the walls of a box, within a fixed amount of work per frame.
//   game_loop body.orchard
#include <cmath>
#include <cstdio>

#include "orchard/runtime/detector.h"
#include "orchard/runtime/tree_file.h"

using namespace orchard::runtime;

int main(int argc, char** argv) {
  PackedSphereTree tree;
  if (argc != 2 || load_file(argv[1], tree) != LoadStatus::ok) return std::puts("usage: game_loop body.orchard"), 2;
  const double size = tree.bounding_radius, frame_time = 0.02;
  std::vector<BodyState> bodies(27);  // by BodyIndex: steady flight between two bounces
  Detector world(states_of(bodies), {.time_step = frame_time});
  const BodyPart part{world.add_shape(tree), {.translation = -1.0 * Vec3(tree.origin)}};
  for (const Vec3 way : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    world.add_half_space(way, -7 * size), world.add_half_space(-1.0 * way, -7 * size);
  }
  for (int i = 0; i < 27; ++i) {
    BodyState& body = bodies[world.add_body({part}).index];
    body.pose.translation = 3.5 * size * Vec3{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
    body.velocity = 3 * size * Vec3{std::sin(3.0 * i), std::cos(5.0 * i), std::sin(7.0 * i)};
  }
  int bounces = 0;
  for (int frame = 0; frame < 500; ++frame) {
    for (const PairEvent& event : world.step(frame * frame_time, {.work = 20'000}).events) {
      if (event.change == PairChange::end || event.verdict.separation_bound > 0.05 * size) continue;
      const bool wall = event.b.index >= bodies.size();
      BodyState still, &a = bodies[event.a.index], &b = wall ? still : bodies[event.b.index];
      const Vec3 normal = event.verdict.contact.normal;
      const double approach = dot(b.velocity - a.velocity, normal);
      if (approach >= 0) continue;  // on their way apart already
      a.velocity = a.velocity + (wall ? 2 : 1) * approach * normal;
      b.velocity = b.velocity - approach * normal;
      world.cancel(event.a), world.cancel(event.b);  // what was said about their motions is void
      ++bounces;
    }
    for (BodyState& body : bodies) body.pose.translation = body.pose.translation + frame_time * body.velocity;
  }
  std::printf("%d bounces in 500 frames\n", bounces);
  return bounces > 0 ? 0 : 1;
}
