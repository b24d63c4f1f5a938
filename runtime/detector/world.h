#pragma once
#include <memory>

#include "detector/kept_states.h"
#include "detector/shape_placements.h"

namespace orchard::runtime::detail {

// The bodies, shapes and options that the application has set, and the step up to which answers have been given. All
// stages of a detector share it. Calls between two steps change it; within a step, only the sampler does, which asks
// where the bodies are.
struct World {
  explicit World(const DetectorOptions& wanted);

  bool contains(BodyId body) const noexcept {
    return is_half_space(body.index) ? halves.contains(body) : bodies.contains(body);
  }
  Body& body(BodyIndex index) noexcept { return is_half_space(index) ? halves.body(index) : bodies[index]; }
  const Body& body(BodyIndex index) const noexcept { return places.body(index); }
  double time_of_last_step() const noexcept { return clock.time(std::max<Step>(answered, 0)); }  // or of step 0
  // Wakes a body. It has rested up to the last step, so its state at that step is known.
  void wake(Body& body) const noexcept {
    if (body.frozen) body.steps.asked = std::max(body.steps.asked, answered);
    body.frozen = false;
  }
  BodyState state(const Body& body) const noexcept {  // as of the last step
    return kept_states && !body.is_static ? kept_states->at(time_of_last_step(), body.id.index) : body.state;
  }
  // Stores the state of a body. Bodies that sleep are at rest.
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
  std::unique_ptr<KeptStates> kept_states;  // null: the application keeps the states
  PairFilter filter;                        // of the application
  std::uint32_t filter_version = 0;         // how often it has been set
  std::size_t body_count = 0;               // half-spaces included
  std::uint64_t changes = 0;                // the number of changes of bodies, shapes and states between steps
  std::uint64_t static_changes = 1;         // the number of changes of static bodies, plus 1
  Step answered = -1;                       // the last step that has been answered
  struct Any {                              // whether there has ever been ..
    bool continuous = false;                // .. a continuous body
    bool static_body = false;               // .. a static body
    bool parts = false;                     // .. a body of several parts
    bool own_filter = false;                // .. a body with a filter of its own
    bool jump = false;                      // .. a teleport, since the last step that was answered
  };
  Any any;
};

}  // namespace orchard::runtime::detail
