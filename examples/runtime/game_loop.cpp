// A game loop: bodies bounce about in a box. The broad phase says whose bounding spheres meet; the narrow phase shares
// a fixed amount of work per frame among these pairs; who touches, or may touch and is close, bounces off.
//   game_loop body.orchard
#include <cmath>
#include <cstdio>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/tree_file.h"

using namespace orchard::runtime;

namespace {

struct Body {
  Vec3 spin;  // axis; turns by 1 radian a second
  double phase;
};

Pose pose_of(const Body& body, const Vec3& position, double time) {
  const double half = (time + body.phase) / 2, s = std::sin(half);
  return *pose_from_quaternion({std::cos(half), s * body.spin[0], s * body.spin[1], s * body.spin[2]}, position);
}

constexpr double kFrame = 0.02;  // seconds

// 27 bodies in a cube of three by three by three, each on its own way.
void start(double radius, std::vector<Body>& bodies, std::vector<Motion>& motions) {
  for (int i = 0; i < 27; ++i) {
    bodies.push_back({{std::sin(i), std::cos(i), 0.5}, 1.0 * i});
    Motion motion;
    motion.position = 3.5 * radius * Vec3{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
    motion.velocity = radius * Vec3{2 * std::sin(3.0 * i), 2 * std::cos(5.0 * i), 2 * std::sin(7.0 * i)};
    motion.radius = radius;
    motions.push_back(motion);
  }
}

// Exchanges what the two velocities have along `normal`; false where the bodies are on their way apart already.
bool bounce(Motion& a, Motion& b, const Vec3& normal) {
  const double approach = dot(b.velocity - a.velocity, normal);
  if (approach >= 0) return false;
  a.velocity = a.velocity + approach * normal, b.velocity = b.velocity - approach * normal;
  return true;
}

// Until the next frame; true where the body turned back at a wall.
bool fly(Motion& motion, double wall) {
  bool turned = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (motion.position[axis] * motion.velocity[axis] <= 0 || std::fabs(motion.position[axis]) < wall) continue;
    motion.velocity[axis] *= -1;
    turned = true;
  }
  motion.position = motion.position + kFrame * motion.velocity;
  return turned;
}

}  // namespace

int main(int argc, char** argv) {
  PackedSphereTree tree;
  const LoadStatus status = argc == 2 ? load_file(argv[1], tree) : LoadStatus::cannot_open;
  if (status != LoadStatus::ok) {
    std::fprintf(stderr, "usage: game_loop body.orchard (%s)\n", message(status));
    return 2;
  }
  // Of a sphere around the body's own origin, about which it turns.
  const double radius = coordinate_extent(tree) + std::sqrt(dot(tree.origin, tree.origin)), wall = 6 * radius;

  std::vector<Body> bodies;
  std::vector<Motion> motions;  // by BodyIndex: steady flight between two bounces
  start(radius, bodies, motions);
  BroadPhase world(values_of(motions), {.time_step = kFrame});
  for (std::size_t i = 0; i < bodies.size(); ++i) world.add();

  std::vector<NarrowPhase> pool;  // one for each pair of a frame; reused, so that later frames allocate nothing
  std::size_t pairs = 0, answers[3] = {}, bounces = 0;
  for (int frame = 0; frame < 500; ++frame) {
    const double time = frame * kFrame;
    const Advance now = world.advance(time);
    while (pool.size() < now.pairs.size()) pool.emplace_back(tree, tree, 1024);
    for (std::size_t k = 0; k < now.pairs.size(); ++k) {
      const auto [a, b] = now.pairs[k];
      pool[k].start(pose_of(bodies[a], motions[a].position, time), pose_of(bodies[b], motions[b].position, time));
    }
    // In a program that must keep time: {.time = std::chrono::microseconds(500)}.
    RoundRobin(std::span(pool).first(now.pairs.size())).refine({.pair_tests = 20'000});

    for (std::size_t k = 0; k < now.pairs.size(); ++k) {
      const Verdict verdict = pool[k].verdict();
      ++pairs, ++answers[static_cast<int>(verdict.answer)];
      if (verdict.answer == Answer::no) continue;
      if (verdict.answer == Answer::maybe && verdict.separation_bound > 0.05 * radius) continue;
      const auto [a, b] = now.pairs[k];
      if (!bounce(motions[a], motions[b], verdict.contact.normal)) continue;
      ++bounces;
      // What was said about their motions is void.
      world.cancel(world.id_of(a)), world.cancel(world.id_of(b));
    }
    for (BodyIndex i = 0; i < motions.size(); ++i) {
      if (fly(motions[i], wall)) world.cancel(world.id_of(i));
    }
  }
  std::printf("%zu pairs of spheres met in 500 frames: %zu no, %zu maybe, %zu yes; %zu bounces\n", pairs, answers[0],
              answers[1], answers[2], bounces);
  return answers[0] > 0 && bounces > 0 ? 0 : 1;
}
