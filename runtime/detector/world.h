#pragma once
#include <memory>

#include "detector/kept_states.h"
#include "detector/shape_placements.h"

namespace orchard::runtime::detail {

// What the application has said of its bodies, and up to which step it has been answered. The parts of a detector share
// it: calls between two steps change it, and within a step only the sampler does, which asks where the bodies are.
struct World {
  explicit World(const DetectorOptions& wanted);

  bool contains(BodyId body) const noexcept {
    return is_half_space(body.index) ? halves.contains(body) : bodies.contains(body);
  }
  Body& body(BodyIndex index) noexcept { return is_half_space(index) ? halves.body(index) : bodies[index]; }
  const Body& body(BodyIndex index) const noexcept { return places.body(index); }
  double time_of_last_step() const noexcept { return clock.time(std::max<Step>(answered, 0)); }  // or of the first one
  // It has rested up to the last step: where it was then is known.
  void wake(Body& body) const noexcept {
    if (body.frozen) body.steps.asked = std::max(body.steps.asked, answered);
    body.frozen = false;
  }
  BodyState state(const Body& body) const noexcept {  // as of the last step
    return kept_states && !body.is_static ? kept_states->at(time_of_last_step(), body.id.index) : body.state;
  }
  // What sleeps is at rest.
  void keep_state(const Body& body, BodyState state) {
    if (body.asleep) state.velocity = {};
    kept_states->put(body.id.index, time_of_last_step(), state);
  }
  bool filters_exclude(const BodyPair& pair) const {  // two bodies of the broad phase
    const Body &a = bodies[pair.a], &b = bodies[pair.b];
    return !filters_allow(a, b) || (filter && !filter(a.id, b.id));
  }

  DetectorOptions options;
  Clock clock;
  ShapeTable shapes;
  BodyTable bodies;
  HalfSpaces halves;
  HalfSpaceTimes half_space_times{halves};
  ShapePlacements places{shapes, bodies, halves};
  std::unique_ptr<KeptStates> kept_states;  // null: the application has them
  PairFilter filter;
  std::uint32_t filter_version = 0;
  std::size_t body_count = 0;        // half-spaces included
  std::uint64_t changes = 0;         // of bodies, shapes and states between steps
  std::uint64_t static_changes = 1;  // of static bodies
  Step answered = -1;                // up to which steps have been answered
  struct Any {
    bool continuous = false;   // body, ever
    bool static_body = false;  // ever
    bool parts = false;        // body of several, ever
    bool own_filter = false;   // of a body, ever
    bool jump = false;         // of a body, since the last step that was answered
  };
  Any any;
};

}  // namespace orchard::runtime::detail
