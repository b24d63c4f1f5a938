#include "scene_run.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime::test {
namespace {

std::uint64_t key(BodyId id) { return std::uint64_t{id.generation} << 32 | id.index; }

}  // namespace

SceneRun::SceneRun(const Scene& scene, DetectorOptions options, Promises promises, int horizon)
    : scene_(&scene), bounds_(promises), horizon_(horizon), ids_(scene.bodies.size()) {
  options.time_step = scene.dt;
  options.watch = promises != Promises::known;
  const auto source = [this](double time, std::span<const BodyIndex> bodies, std::span<BodyState> states) {
    const int at = static_cast<int>(std::lround(time / scene_->dt)), step = recorded(at);
    const bool forth = at == step;  // what is played back cannot be foretold by looking forward
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::size_t body = bodies_[bodies[i]];
      if (bounds_ == Promises::suggested) {
        states[i] = BodyState{};
        states[i].pose = scene_->poses[static_cast<std::size_t>(step)][body];
      } else {
        states[i] = scene_->state(step, body, forth ? horizon_ : 0);
        if (!forth) states[i].expiry = time, states[i].velocity = {};
      }
    }
  };
  detector_ = std::make_unique<Detector>(source, options);
  for (const SceneShape& shape : scene.shapes) {
    switch (shape.kind) {
      case SceneShape::Kind::tree:
        shapes_.push_back(detector_->add_shape(shape.tree));
        break;
      case SceneShape::Kind::round:
        shapes_.push_back(detector_->add_capsule(shape.p, shape.q, shape.radius));
        break;
      case SceneShape::Kind::box:
        shapes_.push_back(detector_->add_box(shape.p));
        break;
    }
  }
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const BodyId id = detector_->add_half_space(scene.planes[i].normal, scene.planes[i].offset);
    numbers_[key(id)] = scene.bodies.size() + i;
  }
}

int SceneRun::recorded(int time_step) const {
  const int period = 2 * scene_->steps, phase = time_step % period;
  return phase < scene_->steps ? phase : period - 1 - phase;
}

void SceneRun::add(std::size_t body) {
  const SceneBody& with = scene_->bodies[body];
  std::vector<BodyPart> parts;
  for (std::size_t k = 0; k < with.parts.size(); ++k) {
    parts.push_back({shapes_[with.parts[k]], scene_->local(step_, body, k)});
  }
  BodyOptions options = with.options;
  options.suggest = bounds_ == Promises::suggested;
  const Pose& pose = scene_->poses[static_cast<std::size_t>(step_)][body];
  const BodyId id = with.is_static ? detector_->add_static(parts, pose, options) : detector_->add_body(parts, options);
  ids_[body] = id;
  if (bodies_.size() <= id.index) bodies_.resize(std::size_t{id.index} + 1);
  bodies_[id.index] = body;
  numbers_[key(id)] = body;
}

Frame SceneRun::step(int time_step, const Budget& budget, const StepOptions& options) {
  step_ = recorded(time_step);
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    const bool there = scene_->bodies[i].birth <= step_ && step_ < scene_->bodies[i].death;
    if (there && ids_[i] == kNoBody) add(i);
    if (!there && ids_[i] != kNoBody) {
      detector_->remove(ids_[i]);
      ids_[i] = kNoBody;
    }
    for (std::size_t k = 0; there && !scene_->locals.empty() && k < scene_->bodies[i].parts.size(); ++k) {
      if (!scene_->bodies[i].is_static) detector_->set_local(ids_[i], k, scene_->local(step_, i, k));
    }
  }
  return detector_->step(time_step * scene_->dt, budget, options);
}

std::size_t SceneRun::number(BodyId id) const { return numbers_.at(key(id)); }

std::pair<std::size_t, std::size_t> SceneRun::numbers(const PairEvent& event) const {
  return std::minmax({number(event.a), number(event.b)});
}

void append(std::vector<double>& all, const Frame& frame) {
  all.push_back(static_cast<double>(frame.work));
  all.push_back(static_cast<double>(frame.certain));
  all.push_back(frame.worst_bound);
  for (const PairEvent& event : frame.events) {
    const Verdict& v = event.verdict;
    all.insert(all.end(),
               {static_cast<double>(event.change), static_cast<double>(event.a.index),
                static_cast<double>(event.b.index), static_cast<double>(event.part_a),
                static_cast<double>(event.part_b), event.time, static_cast<double>(v.answer), v.separation_bound,
                v.lower_bound, static_cast<double>(v.level), static_cast<double>(v.work), v.contact.radius});
    all.insert(all.end(), v.contact.center.begin(), v.contact.center.end());
    all.insert(all.end(), v.contact.normal.begin(), v.contact.normal.end());
  }
}

}  // namespace orchard::runtime::test
