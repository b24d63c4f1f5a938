#include "detection.h"

#include <algorithm>
#include <chrono>

namespace orchard::simulation {
namespace {

constexpr std::size_t kRoom = 4096;  // meeting pairs of spheres a level, of each pair of bodies

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Motion motion_of(const Body& body) {
  Motion motion;
  motion.position = body.position;
  motion.velocity = body.velocity;
  motion.radius = body.radius;
  motion.acceleration = body.acceleration;
  motion.drift = body.drift;
  motion.half_space = body.half_space;
  motion.expiry = body.expiry;
  return motion;
}

}  // namespace

bool unlimited(const runtime::Budget& budget) {
  return budget.pair_tests == runtime::Budget{}.pair_tests && budget.time == runtime::Budget{}.time;
}

Shape shape_of(const runtime::TreeView& tree) {
  const runtime::SiblingBlock& root = tree.blocks[0];
  // What a rotation in double may add.
  return {tree,
          {tree.origin[0] + root.x[0], tree.origin[1] + root.y[0], tree.origin[2] + root.z[0]},
          double{root.radius[0]} * (1 + 1e-9)};
}

Pose pose_of(const Body& body, const Shape& shape) {
  Pose pose = runtime::pose_from_quaternion(body.attitude, {0, 0, 0}).value_or(Pose{});
  pose.scale = body.scale;
  pose.translation = body.position - body.scale * turned(body.attitude, shape.center);
  return pose;
}

Detection::Detection(const std::vector<Body>& bodies, const std::vector<Shape>& shapes, double time_step)
    : bodies_(bodies),
      shapes_(shapes),
      broad_(
          [this](double time, std::span<const runtime::BodyIndex> asked, std::span<Motion> motions) {
            for (std::size_t i = 0; i < asked.size(); ++i) {
              const std::uint32_t body = body_of_[asked[i]];
              motions[i] = motion_of(bodies_[body]);
              promises_[body] = {motions[i], time};
            }
          },
          {.time_step = time_step}) {}

void Detection::add(std::uint32_t body) {
  if (ids_.size() <= body) {
    ids_.resize(body + 1, runtime::kNoBody);
    promises_.resize(body + 1);
  }
  const Body& b = bodies_[body];
  const runtime::BodyId id = b.fixed ? broad_.add_static(motion_of(b)) : broad_.add();
  ids_[body] = id;
  if (body_of_.size() <= id.index) body_of_.resize(id.index + 1);
  body_of_[id.index] = body;
}

void Detection::remove(std::uint32_t body) {
  broad_.remove(ids_[body]);
  ids_[body] = runtime::kNoBody;
}

void Detection::cancel(std::uint32_t body) { broad_.cancel(ids_[body]); }

runtime::NarrowPhase& Detection::narrow(std::uint32_t shape_a, std::uint32_t shape_b) {
  Pool& pool = pools_[{shape_a, shape_b}];
  if (pool.used == pool.pairs.size())
    pool.pairs.push_back(std::make_unique<runtime::NarrowPhase>(shapes_[shape_a].tree, shapes_[shape_b].tree, kRoom));
  return *pool.pairs[pool.used++];
}

// A level each in turn, so that no pair gets a second one before all have had the first. Where the budget's work ends
// within a level the same work ends there again, which is what makes a timed run repeatable.
void Detection::refine(std::vector<runtime::NarrowPhase*>& pairs, const runtime::Budget& budget, StepOutcome& outcome) {
  const auto begin = std::chrono::steady_clock::now();
  std::uint64_t left = budget.pair_tests;
  const bool straight = unlimited(budget);
  const auto time_left = [&] {
    return budget.time == std::chrono::nanoseconds::max()
               ? budget.time
               : budget.time -
                     std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - begin);
  };
  while (!pairs.empty()) {
    for (runtime::NarrowPhase* pair : pairs) {
      const auto time = time_left();
      if (left == 0 || time.count() <= 0) return;
      const std::uint64_t before = pair->verdict().work;
      // Bounds on the way are for those who may have to stop on it.
      if (straight) {
        pair->refine_exactly();
      } else {
        pair->refine({left, time});
      }
      const std::uint64_t spent = pair->verdict().work - before;
      outcome.work += spent;
      outcome.refined += spent;
      left -= std::min(left, spent);
    }
    std::erase_if(pairs, [](const runtime::NarrowPhase* pair) { return pair->finished(); });
  }
}

StepOutcome Detection::step(double time, const runtime::Budget& budget) {
  StepOutcome outcome;
  for (auto& [kind, pool] : pools_) pool.used = 0;
  const std::uint64_t asked = broad_.motions_asked();
  auto begin = std::chrono::steady_clock::now();
  const runtime::Advance advance = broad_.advance(time);
  outcome.seconds_broad = seconds_since(begin);
  outcome.motions = broad_.motions_asked() - asked;

  begin = std::chrono::steady_clock::now();
  std::vector<runtime::NarrowPhase*> all, open;
  for (const runtime::BodyPair& pair : advance.pairs) {
    const std::uint32_t first = body_of_[pair.a], second = body_of_[pair.b];
    const std::uint32_t a = std::min(first, second), b = std::max(first, second);
    const Body &body_a = bodies_[a], &body_b = bodies_[b];
    runtime::NarrowPhase& phase = narrow(body_a.shape, body_b.shape);
    phase.start(pose_of(body_a, shapes_[body_a.shape]), pose_of(body_b, shapes_[body_b.shape]));
    outcome.work += phase.verdict().work;
    outcome.pairs.push_back({a, b, {}, false});
    all.push_back(&phase);
    if (!phase.finished()) open.push_back(&phase);
  }
  refine(open, budget, outcome);
  for (std::size_t i = 0; i < all.size(); ++i) {
    outcome.pairs[i].verdict = all[i]->verdict();
    outcome.pairs[i].exact = all[i]->exact();
  }
  std::sort(outcome.pairs.begin(), outcome.pairs.end(),
            [](const PairOutcome& x, const PairOutcome& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  outcome.seconds_narrow = seconds_since(begin);
  return outcome;
}

}  // namespace orchard::simulation
