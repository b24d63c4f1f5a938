#include "orchard/runtime/detector.h"

#include "detector/detector_state.h"
#include "math/vector_functions.h"

// The construction of a detector, its shapes, and the functions that return facts about it.
namespace orchard::runtime {

namespace {

bool is_valid_option(const DetectorOptions& options) noexcept {
  return options.steps_to_end >= 1 && options.max_events >= 1 &&
         is_valid(BroadPhaseOptions{
             .time_step = options.time_step, .start = options.start, .position_slack = options.position_slack});
}

BroadPhaseOptions broad_options(const DetectorOptions& options, const Executor& executor) noexcept {
  // This is less than the default. Answering pairs leaves little of the broad phase in the caches, so one thread has no
  // advantage there.
  constexpr std::size_t kMinBodies = 4096;
  return {.time_step = options.time_step,
          .start = options.start,
          .position_slack = options.position_slack,
          .executor = executor,
          .min_bodies_for_jobs = kMinBodies};
}

}  // namespace

detail::World::World(const DetectorOptions& wanted)
    : options(wanted),
      clock{is_valid_option(wanted) ? wanted.start : 0, is_valid_option(wanted) ? wanted.time_step : 1} {}

// The jobs of the broad phase ask for motions. They run at the same time only if the states of all bodies have been
// sampled already; otherwise, they run one after another.
Detector::State::State(StateSource source, const DetectorOptions& wanted)
    : world(wanted),
      broad([this](double time, std::span<const BodyIndex> asked,
                   std::span<Motion> answers) { sampler.answer_broad_phase(time, asked, answers); },
            broad_options(wanted, {[](void* context, std::size_t count, Executor::Job job, void* data) {
                                     const State& state = *static_cast<const State*>(context);
                                     const Executor& executor = state.world.options.executor;
                                     if (state.sampler.sampled_all() && executor.run != nullptr)
                                       return executor.run(executor.context, count, job, data);
                                     for (std::size_t i = 0; i < count; ++i) job(data, i);
                                   },
                                   this, 1})),
      sampler(world, broad, std::move(source)),
      part_pairs(world, broad, sampler),
      matcher(world, sampler, part_pairs),
      skipper(world),
      scheduler(world),
      reporter(world, skipper),
      queries(world, sampler),
      valid(is_valid_option(wanted)) {}

Detector::Detector(StateSource source, const DetectorOptions& options)
    : state_(std::make_unique<State>(std::move(source), options)) {}
Detector::Detector(const DetectorOptions& options) {
  auto kept = std::make_unique<detail::KeptStates>(!options.watch.value_or(false));
  const auto fill = [states = kept.get()](double time, std::span<const BodyIndex> bodies,
                                          std::span<BodyState> answers) { states->fill(time, bodies, answers); };
  DetectorOptions with = options;
  with.watch = options.watch.value_or(false);
  state_ = std::make_unique<State>(fill, with);
  state_->world.kept_states = std::move(kept);
}
Detector::Detector(Detector&&) noexcept = default;
Detector& Detector::operator=(Detector&&) noexcept = default;
Detector::~Detector() = default;

ShapeId Detector::add_shape(const TreeView& tree) {
  return state_->stepping ? kNoShape : state_->world.shapes.add_tree(tree);
}
ShapeId Detector::load_shape(const char* path, LoadStatus* status) {
  PackedSphereTree tree;
  const LoadStatus loaded = load_file(path, tree);
  if (status != nullptr) *status = loaded;
  return loaded == LoadStatus::ok && !state_->stepping ? state_->world.shapes.add_tree(std::move(tree)) : kNoShape;
}
ShapeId Detector::add_sphere(double radius, const Vec3& center) { return add_capsule(center, center, radius); }
ShapeId Detector::add_capsule(const Vec3& p, const Vec3& q, double radius) {
  return state_->stepping ? kNoShape : state_->world.shapes.add_round(p, q, radius);
}
ShapeId Detector::add_box(const Vec3& half_lengths) {
  return state_->stepping ? kNoShape : state_->world.shapes.add_box(half_lengths);
}

void Detector::set_executor(const Executor& executor) noexcept {
  if (!state_->stepping) state_->world.options.executor = executor;
}
bool Detector::contains(BodyId body) const noexcept { return state_->contains(body); }
double Detector::reach(ShapeId shape) const noexcept {
  const detail::ShapeTable& shapes = state_->world.shapes;
  return shapes.contains(shape) ? (length(shapes[shape].center) + shapes[shape].reach) * (1 + 1e-15) : 0;
}
std::size_t Detector::size() const noexcept { return state_->world.body_count; }
bool Detector::valid() const noexcept { return state_->valid; }
std::uint64_t Detector::motion_bound_violations() const noexcept { return state_->sampler.monitor().broken(); }
std::uint64_t Detector::motion_bound_violations(BodyId body) const noexcept {
  return state_->contains(body) ? state_->sampler.monitor().broken(body.index) : 0;
}

std::size_t Detector::memory_bytes() const noexcept {
  const State& s = *state_;
  const detail::World& world = s.world;
  return sizeof(State) + (world.kept_states ? world.kept_states->memory_bytes() : 0) + world.shapes.memory_bytes() +
         world.bodies.memory_bytes() + world.halves.memory_bytes() + world.half_space_times.memory_bytes() +
         s.broad.memory_bytes() + s.sampler.memory_bytes() + s.part_pairs.memory_bytes() + s.matcher.memory_bytes() +
         s.skipper.memory_bytes() + s.scheduler.memory_bytes() + s.reporter.memory_bytes() + s.queries.memory_bytes() +
         detail::bytes_of(s.open_pairs);
}

}  // namespace orchard::runtime
