#include "detection.h"

#include <algorithm>
#include <chrono>

namespace orchard::simulation {

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

runtime::DetectorOptions Detection::options(double time_step) {
  runtime::DetectorOptions options;
  options.time_step = time_step;
  options.watch = false;  // the scenes keep what they promise, and cancel the rest
  options.bound_given = [this](double time, runtime::BodyIndex body, const Motion& bound) {
    promises_[body_of_[body]] = {bound, time};
  };
  return options;
}

Detection::Detection(const std::vector<Body>& bodies, const std::vector<Shape>& shapes, double time_step)
    : bodies_(bodies),
      shapes_(shapes),
      detector_(
          [this](double, std::span<const runtime::BodyIndex> asked, std::span<runtime::BodyState> states) {
            for (std::size_t i = 0; i < asked.size(); ++i) states[i] = state_of(body_of_[asked[i]]);
          },
          options(time_step)) {
  for (const Shape& shape : shapes_) shape_ids_.push_back(detector_.add_shape(shape.tree));
}

// What moves is the middle of the bounding sphere, so that a body turns about it and its reach is the sphere's radius.
runtime::BodyState Detection::state_of(std::uint32_t body) const {
  const Body& b = bodies_[body];
  runtime::BodyState state;
  state.pose = runtime::pose_from_quaternion(b.attitude, b.position).value_or(Pose{});
  state.pose.scale = b.scale;
  state.velocity = b.velocity;
  state.acceleration = b.acceleration;
  state.drift = b.drift;
  state.half_space = b.half_space;
  state.expiry = b.expiry;
  return state;
}

void Detection::add(std::uint32_t body) {
  if (ids_.size() <= body) {
    ids_.resize(body + 1, runtime::kNoBody);
    promises_.resize(body + 1);
  }
  const Body& b = bodies_[body];
  runtime::BodyPart part{shape_ids_[b.shape]};
  part.local.translation = -1.0 * shapes_[b.shape].center;
  const runtime::BodyId id = b.fixed ? detector_.add_static({part}, state_of(body).pose) : detector_.add_body({part});
  ids_[body] = id;
  if (body_of_.size() <= id.index) body_of_.resize(id.index + 1);
  body_of_[id.index] = body;
}

void Detection::remove(std::uint32_t body) {
  detector_.remove(ids_[body]);
  ids_[body] = runtime::kNoBody;
}

void Detection::cancel(std::uint32_t body) { detector_.cancel(ids_[body]); }

void Detection::teleport(std::uint32_t body) { detector_.teleport(ids_[body]); }

StepOutcome Detection::step(double time, const runtime::Budget& budget, const runtime::StepCut* replay) {
  const auto begin = std::chrono::steady_clock::now();
  const runtime::Frame frame = detector_.step(time, budget, {.replay = replay});
  StepOutcome outcome;
  outcome.overlapping = frame.pairs;
  outcome.work = frame.work;
  outcome.motions = frame.motions_asked;
  outcome.left_over = frame.unfinished.left_over;
  outcome.cut = frame.cut;
  for (const runtime::PairEvent& event : frame.events) {
    if (event.change == runtime::PairChange::end || event.verdict.answer == runtime::Answer::no) continue;
    const std::uint32_t first = body_of_[event.a.index], second = body_of_[event.b.index];
    outcome.pairs.push_back({std::min(first, second), std::max(first, second), event.verdict});
  }
  std::sort(outcome.pairs.begin(), outcome.pairs.end(),
            [](const PairOutcome& x, const PairOutcome& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

}  // namespace orchard::simulation
