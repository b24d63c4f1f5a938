#include "orchard/runtime/orchard_broad_phase.h"
#include "orchard/runtime/orchard_detector.h"
#include "record.h"

namespace orchard::web {

namespace {

constexpr std::size_t kBodies = 200, kSteps = 120;
constexpr double kTimeStep = 1.0 / 64;

// Straight flight from here; a row is position, velocity, radius.
struct Flight {
  double position[3], velocity[3], radius;
};

void fly(void* context, double time, const std::uint32_t* bodies, std::size_t count, orchard_motion* motions) {
  const auto& flights = *static_cast<const std::vector<Flight>*>(context);
  for (std::size_t i = 0; i < count; ++i) {
    const Flight& flight = flights[bodies[i]];
    orchard_motion motion = orchard_default_motion();
    for (std::size_t k = 0; k < 3; ++k) {
      motion.position[k] = flight.position[k] + time * flight.velocity[k];
      motion.velocity[k] = flight.velocity[k];
    }
    motion.radius = flight.radius;
    motions[i] = motion;
  }
}

}  // namespace

void record_broad_phase(Recording& recording, Draws& draws) {
  std::vector<Flight> flights(kBodies);
  Row arguments, answers;
  arguments.add_all(kTimeStep, kSteps, kBodies);
  for (Flight& flight : flights) {
    for (double& x : flight.position) x = draws.uniform(-10, 10);
    for (double& v : flight.velocity) v = draws.uniform(-5, 5);
    flight.radius = draws.uniform(0.2, 1);
    arguments.add(flight.position, 3).add(flight.velocity, 3).add_all(flight.radius);
  }
  orchard_broad_phase_options options = orchard_default_broad_phase();
  options.time_step = kTimeStep;
  orchard_broad_phase* const world = orchard_broad_phase_new(fly, &flights, &options);
  for (std::size_t i = 0; i < kBodies; ++i) orchard_broad_phase_add(world, 0, nullptr);
  for (std::size_t step = 0; step < kSteps; ++step) {
    const double now = static_cast<double>(step) * kTimeStep;
    for (;;) {
      const orchard_advance report = orchard_broad_phase_advance(world, now, nullptr, 0);
      answers.add_all(report.time, report.pair_count);
      for (std::size_t i = 0; i < 2 * report.pair_count; ++i) answers.add_all(report.pairs[i]);
      if (report.pair_count == 0) break;
    }
  }
  orchard_broad_phase_free(world);
  recording.add(Kind::broad_phase, arguments, answers);
}

void record_detector(Recording& recording, Draws& draws, const std::vector<orchard_tree*>& trees) {
  Row arguments, answers;
  orchard_detector_options options = orchard_default_detector();
  options.time_step = kTimeStep;
  orchard_detector* const world = orchard_detector_new(nullptr, nullptr, &options);
  std::vector<orchard_shape> shapes;
  shapes.reserve(trees.size());
  for (const orchard_tree* tree : trees) shapes.push_back(orchard_detector_add_tree(world, tree));
  arguments.add_all(kTimeStep, kSteps, kBodies);
  for (std::size_t i = 0; i < kBodies; ++i) {
    const std::size_t shape = draws.below(shapes.size());
    orchard_part part{shapes[shape], orchard_identity()};
    const orchard_body_options body_options = orchard_default_body();
    const orchard_body body = orchard_detector_add_body(world, &part, 1, &body_options);
    orchard_body_state state = orchard_default_state();
    const double turn[4] = {draws.uniform(-1, 1), draws.uniform(-1, 1), draws.uniform(-1, 1), draws.uniform(0.5, 1)};
    const double place[3] = {draws.uniform(-30, 30), draws.uniform(-30, 30), draws.uniform(-30, 30)};
    orchard_pose_from_quaternion(turn, place, &state.pose);
    for (double& v : state.velocity) v = draws.uniform(-8, 8);
    orchard_detector_set_state(world, body, &state);
    arguments.add_all(shape).add(state.pose).add(state.velocity, 3);
  }
  for (std::size_t step = 1; step <= kSteps; ++step) {
    const orchard_frame frame =
        orchard_detector_step(world, static_cast<double>(step) * kTimeStep, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT});
    answers.add_all(frame.time, frame.counts.pairs, frame.counts.certain, frame.counts.work, frame.events);
    for (std::size_t i = 0; i < frame.events; ++i) {
      const orchard_pair_event event = orchard_detector_event(world, i);
      answers.add_all(event.change, event.a.index, event.b.index, event.time);
      answers.add(event.verdict);
    }
  }
  orchard_detector_free(world);
  recording.add(Kind::detector, arguments, answers);
}

}  // namespace orchard::web
