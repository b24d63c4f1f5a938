#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "orchard/runtime/broad_queries.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/execution.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"

// The complete detector of the dissertation's Fig. 3.2: broad phase, narrow phase, and a schedule that keeps to a
// budget.
//
//   Detector world({.time_step = 1.0 / 60});
//   const ShapeId hull = world.load_shape("hull.orchard");
//   const BodyId ship = world.add_body(hull, {.velocity = {1, 0, 0}});
//   while (running) {
//     for (const PairEvent& event : world.step(time, {.work = 100'000}).events) respond(event);    // set_velocity(..)
//   }
namespace orchard::runtime {

// Identifies a shape of a Detector. Any number of bodies may share a shape. Shapes are never removed.
using ShapeId = std::uint32_t;
inline constexpr ShapeId kNoShape = 0xffffffffu;

// The index of the half-space that is added first; further half-spaces have the following indices, and none of these is
// reused. All other bodies have indices below kMaxBodies, which are reused after a body is removed. So an array by
// BodyId::index can hold bodies, and an array by half_space_number() can hold half-spaces.
inline constexpr BodyIndex kFirstHalfSpace = 0xf0000000u;
// Returns whether a body is a half-space.
constexpr bool is_half_space(const BodyId& body) noexcept {
  return body.index >= kFirstHalfSpace && body.index != kNoIndex;
}
// Returns the number of a half-space in the order of adding, from 0. Precondition: is_half_space(body).
constexpr std::uint32_t half_space_number(const BodyId& body) noexcept { return body.index - kFirstHalfSpace; }

// A rigid part of a body. `local` is its pose relative to the body: points of the shape are transformed by `local` and
// then by the pose of the body. The lengths of the shape are multiplied by the scales of both.
struct BodyPart {
  ShapeId shape = kNoShape;
  Pose local{};
};

// The state of a body at the time of a step, and bounds on its motion until an expiry. The bounds are about the body's
// origin, pose.translation: see Motion in motion.h, which has the same fields. The scale must not change until the
// bounds expire. A state with a pose and a velocity and nothing else says that the body moves straight for ever.
// DetectorOptions::watch, which is on by default if a source gives the states, finds at every step the bodies that have
// exceeded their bounds.
struct BodyState {
  Pose pose{};
  Vec3 velocity{};
  double acceleration = 0;
  double drift = 0;
  Vec3 half_space{};
  double expiry = std::numeric_limits<double>::infinity();
  // An upper bound on the angular speed until the bounds expire, in radians per second, at least 0. Set it for bodies
  // whose origin is not in their middle: if there is no bound (infinity), the farthest point of such a body may soon be
  // on any side of its origin.
  double angular_speed = std::numeric_limits<double>::infinity();
};

// A callback that fills states[i] with the state of bodies[i] at `time`, the time of a step. It must not throw.
// step() calls it in the thread that called step().
// While a source, a filter or a listener runs, the detector that called it refuses every change and every call of
// step(), manifold() and predict_load(): they return what they return for a body that does not exist, and
// Frame::time_refused is true. Destroying or moving the detector there is an error.
using StateSource = std::function<void(double time, std::span<const BodyIndex> bodies, std::span<BodyState> states)>;

// Returns a source that reads the state of body i from values[i]. The application keeps these values up to date: they
// hold at the time that it passes to step(). `values` must outlive the detector and have an element for the index of
// each moving body. Static bodies use indices, too, so a moving body that was added after them has a higher index. A
// body without a value is in no pair: see Frame::refused.
StateSource states_of(const std::vector<BodyState>& values);

// Properties of a body.
struct BodyOptions {
  // The class of importance; 0 is the highest. A pair is as important as the less important of its bodies.
  std::uint8_t importance = 0;
  // Which pairs the body is in. The broad phase does not create other pairs, so they cost nothing. Half-spaces are
  // static.
  BodyFilter filter{};
  // If this is above 0, contacts between two steps are found, too. time_of_impact() then assumes that between the poses
  // of the two steps the centre of each part moves straight, and that the part turns by the smallest angle. The value
  // is a bound, in lengths per second: the origin of this body must not move faster relative to the origin of any body
  // that it may meet. If the scale changes during a step, the result is `possible`.
  double continuous_speed = 0;
  // The distance from the origin at scale 1 within which the body always lies, whatever its parts do. It avoids a
  // window update each time an articulated body stretches. 0 uses the reach of the present parts.
  double reach = 0;
  // Whether the motion monitor suggests acceleration, drift, half-space and expiry. The source then gives only poses,
  // and a velocity if it has one. add_body() refuses this option if DetectorOptions::watch is off, since a guess has to
  // be checked.
  bool suggest = false;
};

// An observer, for debugging and visualisation. It receives the motion that the broad phase relies on from `time` until
// it asks for the body again. The motion is that of the body's origin or, if BodyState::angular_speed allows it, of its
// middle.
using MotionBoundListener = std::function<void(double time, BodyIndex body, const Motion& bound)>;

// The options of a Detector.
struct DetectorOptions {
  double time_step = 0.01;    // The time between steps (dt_d), above 0, usually a frame; see BroadPhaseOptions.
  double start = 0;           // The time of step 0.
  double position_slack = 0;  // The error of positions; see BroadPhaseOptions.
  // Whether each step asks for the state of every moving body and compares it with the motion bounds (4.4). Bounds that
  // do not hold are cancelled in time for this step and counted, and Frame::broken names the body; so no contact is
  // missed. Without it, the detector asks for a body only if a result depends on it, which costs less
  // (docs/guide/detector.md). Contacts are then missed silently if a body exceeds its bounds and cancel() is not
  // called. Without a value, it is on with a state source, and off if the detector keeps the states, because
  // set_state() cancels the bounds that it changes.
  std::optional<bool> watch{};
  // The number of successive steps with a certain "no" after which a contact ends, at least 1. Raise it to debounce
  // pairs that jitter at contact.
  std::uint32_t steps_to_end = 1;
  // A call of step() ends once it has at least this number of events, at least 1. So its memory does not grow with the
  // length of a pause: see Unfinished::steps_left.
  std::size_t max_events = std::size_t{1} << 18;
  // Runs pairs, poses and events in parallel, and the broad phase's windows if many bodies are in pairs. Results are
  // the same with any executor. Sources and filters are always called in the thread that calls step().
  Executor executor{};
  // step() calls this whenever the broad phase receives the motion of a body. It must not throw.
  MotionBoundListener bound_given{};
};

// Records where a time budget ended the stages of a step, so that StepOptions::replay can repeat the step. A stage that
// was not interrupted has kWholeStep.
struct StepCut {
  std::uint64_t broad = kWholeStep;    // The broad phase: `replay` of BroadPhase::advance().
  std::uint64_t begun = kWholeStep;    // The number of pairs of parts started.
  std::uint64_t refined = kWholeStep;  // The work of searches, plus 1 for each of them.
  std::uint64_t swept = kWholeStep;    // The number of pairs swept.
  friend bool operator==(const StepCut&, const StepCut&) = default;
};

// Costs in units of Budget::work. A unit of work of a Detector is one of NarrowPhase. A motion that the broad phase
// asks for costs kMotionWork, starting a pair costs kPairWork, and a pair with a simple shape costs kSimplePairWork.
// The broad phase gets at most half of a limited budget, and sweeps get half of the rest. A step may exceed `work` by
// less than kMaxOvershoot, the cost of one pair of leaves; it also makes one unit of progress in the broad phase under
// any budget. With a budget in time, the work that every step needs is predicted from earlier steps and reserved; if
// this work alone takes longer, the step exceeds its budget. Only a budget in work gives the same answers on every
// machine; a step that a budget in time interrupted can be replayed.
inline constexpr std::uint64_t kMotionWork = 16;
inline constexpr std::uint64_t kPairWork = 16;
inline constexpr std::uint64_t kSimplePairWork = 64;
inline constexpr std::uint64_t kMaxOvershoot = std::uint64_t{kLeafPairTests} * kTriangleTestCost + kBlockWidth;

// The options of Detector::step().
struct StepOptions {
  // If not null, the step ends where the step of another run ended (its Frame::cut) instead of at the time budget.
  // After the same calls with the same states, the frame equals that of the other run. A replayed call answers at most
  // one step, and neither run may use an executor.
  const StepCut* replay = nullptr;
  // Whether only the last step up to the given time is answered; use it after a pause. Unfinished::skipped counts the
  // steps before it. Contacts that existed only at skipped steps are not reported, and sweeps of continuous bodies do
  // not include them. Contacts that held before and hold now continue; other contacts end.
  bool latest_only = false;
};

// What an event reports of a pair.
enum class PairChange : std::uint8_t {
  begin,  // The first certain "yes".
  stay,   // The pair began to touch at an earlier step and has not been certainly apart since.
  end,    // A pair that touched is certainly apart (for steps_to_end steps), or a body was removed or teleported.
  // Whether the pair touches at this step is not known, because the budget ended or the input does not determine it.
  possible,
};

// One pair at one step. a.index < b.index, except that half-spaces are always b.
struct PairEvent {
  PairChange change = PairChange::possible;
  BodyId a, b;
  std::uint32_t part_a = 0, part_b = 0;  // The parts that touch, or those with the smallest bound.
  double time = 0;                       // The time of the step.
  // What is certain at this step. With `stay`, it may be "maybe", or "no" while steps_to_end counts.
  Verdict verdict;
  // The time bracket in which a contact between the previous step and this one begins (continuous bodies); otherwise
  // NaN.
  double impact_from = std::numeric_limits<double>::quiet_NaN();
  double impact_to = std::numeric_limits<double>::quiet_NaN();
};

// What the steps of a call did.
struct FrameCounts {
  std::uint64_t pairs = 0;          // The number of pairs of bodies whose spheres overlapped, summed over the steps.
  std::uint64_t certain = 0;        // The number of these pairs that have a certain answer.
  std::uint64_t work = 0;           // In units of Budget::work.
  std::uint64_t motions_asked = 0;  // Motions asked for; each costs kMotionWork.
  double worst_bound = 0;           // The largest separation bound of the pairs without a certain answer.
};

// What a call of step() did not do.
struct Unfinished {
  // The steps up to the given time that were not answered because DetectorOptions::max_events ended the call. Another
  // call with the same time continues.
  std::uint64_t steps_left = 0;
  std::uint64_t skipped = 0;            // The steps left out by StepOptions::latest_only.
  unsigned incomplete_from = kNoClass;  // Set if the broad phase was interrupted: see Advance.
  std::size_t left_over = 0;            // Set if the broad phase was interrupted: see Advance.
};

// The result of step(). The spans are valid until the next call of a member that is not const.
struct Frame : FrameCounts {
  double time = 0;                    // The time of the last step that was answered.
  double next_time = 0;               // Nothing can begin or end before this time; earlier calls are unnecessary.
  std::uint32_t steps = 0;            // The steps answered in this call.
  std::span<const PairEvent> events;  // Ordered by time, then by pair.
  StepCut cut{};                      // Where the last step ended, for a budget in time without an executor.
  Unfinished unfinished{};
  // Bodies with invalid states or poses that are not rigid. Such a body is in no pair at that step or, while its last
  // bounds still hold, in possible pairs.
  std::span<const BodyIndex> refused;
  std::span<const BodyIndex> broken;  // Bodies that exceeded their bounds, which were cancelled (watch).
  // Nothing was done: the time is not valid (see Advance), or step() was called from within itself.
  bool time_refused = false;
  // There was not enough memory for this step. The detector answers nothing after that; construct another one.
  bool out_of_memory = false;
};

// The predicted cost of a future step, from the broad phase's timing wheel of events (8.2).
struct StepLoad {
  double time = 0;
  std::uint64_t motions = 0;  // Motions that will be asked for, at least.
  double pairs = 0;           // The expected number of overlapping pairs.
  double work = 0;            // The expected work, in units of Budget::work.
};

// The result of a query about all bodies of a world.
struct WorldPoint {
  BodyId body;
  std::uint32_t part = 0;
  // The distance from the query point, 0 inside a solid; for a ray, in multiples of its direction's length.
  double distance = 0;
  // A point of the body; for a ray that begins inside a solid, the ray's origin.
  Vec3 point{};
  std::uint32_t triangle = kNoTriangle;  // The triangle, if the shape is a tree.
};

// Finds the bodies that touch at each step, within a budget. Pairs for which the budget does not suffice have bounds on
// their distance.
//
// Each step answers every pair of bodies that the filters allow and whose spheres overlap, from the poses of that step:
// yes, no, or maybe with bounds. Two bodies touch if and only if two of their parts do. For a body of several parts
// that is near many static bodies, the spheres of its parts have to overlap instead of the sphere around the whole
// body. The parts of one body are never a pair, nor are two static bodies. Trees stand for their surfaces, as in
// NarrowPhase; the simple shapes (sphere, capsule, box, half-space) are solid.
//
// Refinement (7.3) is ordered by class of importance, and within a class the pairs that have waited longest for a
// certain answer come first. All pairs start with cheap tests that decide most of them: spheres, roots, and the result
// of the last step. In addition, a reserved share of the budget takes the other pairs straight to their triangles, one
// after the other, in pieces; a pair that is not finished gets further pieces, each four times as large as the last.
// Pairs without a certain answer have the bounds of their spheres or better. So every pair gets its turn, whatever the
// budget.
//
// The detector is deterministic: the same calls, states and budget in work give the same frames, with any executor.
// Without a budget, the answer of a pair does not depend on other pairs. It allocates nothing once it has held as many
// bodies, pairs and kinds of pairs before. step() throws nothing. The other members throw only std::bad_alloc; after
// that the detector has no bodies and answers nothing: see Frame::out_of_memory. One object must not be used by several
// threads at once.
class Detector {
 public:
  // Constructs a detector that keeps the states of bodies and moves them: see set_state().
  explicit Detector(const DetectorOptions& options = {});
  // Constructs a detector that asks the application for the states of bodies when a result depends on them.
  explicit Detector(StateSource source, const DetectorOptions& options = {});
  Detector(Detector&&) noexcept;
  Detector& operator=(Detector&&) noexcept;
  ~Detector();

  // Adds the shape of a tree. The add functions for shapes return kNoShape if structure_fault(tree) reports a fault, a
  // number is not finite, or a length is negative (a half-length of 0 gives a flat box). Trees must outlive the
  // detector and stay unchanged, except for what FlexibleTree does between steps.
  ShapeId add_shape(const TreeView& tree);
  // Loads a tree that the detector owns. Returns kNoShape if there is no such file or no tree in it, and stores the
  // reason in `status`.
  ShapeId load_shape(const char* path, LoadStatus* status = nullptr);
  ShapeId add_sphere(double radius, const Vec3& center = {});
  ShapeId add_capsule(const Vec3& p, const Vec3& q, double radius);  // The points within `radius` of the segment.
  ShapeId add_box(const Vec3& half_lengths);                         // Around the origin, along the axes.

  // Adds a moving body of several parts. Bodies that are added or changed between two steps take part from the next
  // step on. The add functions for bodies return kNoBody if a part's shape does not exist or its pose is not rigid, if
  // there are no parts, if there are kMaxBodies bodies, or if the options are not valid (`suggest` without `watch`, for
  // example).
  BodyId add_body(std::span<const BodyPart> parts, const BodyOptions& options = {});
  BodyId add_body(std::initializer_list<BodyPart> parts, const BodyOptions& options = {}) {
    return add_body(std::span(parts.begin(), parts.size()), options);
  }
  // Adds a moving body of one part with its state, which holds from the last step on. Returns kNoBody if a source gives
  // the states.
  BodyId add_body(ShapeId shape, const BodyState& state, const BodyOptions& options = {});
  // Adds a body that does not move; its state is never asked for.
  BodyId add_static(std::span<const BodyPart> parts, const Pose& pose, const BodyOptions& options = {});
  BodyId add_static(std::initializer_list<BodyPart> parts, const Pose& pose, const BodyOptions& options = {}) {
    return add_static(std::span(parts.begin(), parts.size()), pose, options);
  }
  // Adds the half-space normal . point <= offset. The normal may have any length but 0. See half_space_number(). The
  // half-space costs nothing for bodies that cannot reach it, since each body has an event of its own, like those of
  // the broad phase.
  BodyId add_half_space(const Vec3& normal, double offset, const BodyOptions& options = {});

  // Removes a body. This function and the following ones change nothing and return false if the body does not exist or
  // an argument is not valid.
  bool remove(BodyId body);
  // Cancels the motion bounds of the body.
  bool cancel(BodyId body);
  // Moves the body to the place that the source gives from now on. A contact ends, and no sweep leads to the new place.
  bool teleport(BodyId body);
  bool move_static(BodyId body, const Pose& pose);
  // Sets the state of a body, if the detector keeps the states. From the time of the last step on (before the first
  // step: from `start`), the body has this state and moves straight at `velocity` without turning, until the next
  // change. Without `watch` this cancels the bounds; with it, bounds are cancelled only if they do not hold. A
  // sleeping body continues to sleep at the new place.
  bool set_state(BodyId body, const BodyState& state);
  // Changes the velocity of a body, which continues from its present place.
  bool set_velocity(BodyId body, const Vec3& velocity);
  // Moves a part of an articulated body; may be called at any time.
  bool set_local(BodyId body, std::size_t part, const Pose& local);
  bool set_importance(BodyId body, std::uint8_t importance);
  bool set_filter(BodyId body, const BodyFilter& filter);
  // Puts a body to sleep: it does not move until wake(). A source is asked for its state at the next step, and then not
  // until it wakes. Pairs of sleeping and static bodies keep their answers at no cost. If the detector keeps the
  // states, the body stops where it is and wakes at rest.
  bool sleep(BodyId body);
  bool wake(BodyId body);
  bool asleep(BodyId body) const noexcept;
  // Invalidates the answers about resting bodies with this shape, after the triangles of its tree have moved
  // (FlexibleTree). O(bodies).
  bool shape_changed(ShapeId shape);
  // Sets the filter of pairs; an empty function allows all pairs. Pairs that already overlap are tested again; see
  // PairFilter in broad_phase.h.
  void set_pair_filter(PairFilter filter);
  void set_executor(const Executor& executor) noexcept;

  // Returns the state at the time of the last step if the detector keeps the states, otherwise the state that the
  // source gave last. Static bodies and half-spaces are at rest.
  BodyState state(BodyId body) const noexcept;
  bool moves(BodyId body) const noexcept;  // Neither static nor a half-space.
  // Returns the distance from the shape's origin within which all its points lie; 0 if there is no such shape.
  double reach(ShapeId shape) const noexcept;
  bool contains(BodyId body) const noexcept;
  std::size_t size() const noexcept;  // The number of bodies, half-spaces included.
  bool valid() const noexcept;        // Whether the options are valid.

  // Answers the steps up to `time` that may have a result, in order; the remaining budget is shared evenly among them.
  // Call it once per frame, with times that do not decrease. A long interval takes long, because each step with a pair,
  // and with `watch` every step, is processed, whatever the budget; StepOptions::latest_only answers only the last
  // step.
  Frame step(double time, const Budget& budget = {}, const StepOptions& options = {}) noexcept;

  // Returns up to four points at which the parts of an event of the last step touch, and the translation that separates
  // them, as contacts() does for two trees. Boxes are solid, so a part wholly inside a box is moved out of it. For a
  // half-space, the points are the outermost ones of the curve in which the surface cuts its plane (for a capsule, the
  // lowest points of its ends), and the depth is that of the lowest point. Spheres and capsules touch any other shape
  // at one point, and their depth is along the normal. If the event's bodies do not exist any more, or if its answer is
  // not yes, the result has no points and the answer "maybe". For a contact between two steps, the result refers to the
  // later step; if the contact is over then, the answer is "no". Throws nothing. Allocates nothing once its memory has
  // grown to the largest pair.
  Manifold manifold(const PairEvent& event, const ContactOptions& options = {}) noexcept;

  // Returns the first point of any body that the ray meets; if several bodies have it, that of the lowest index.
  // This query and the two below include all bodies and half-spaces at the time of the last step, or at `start` before
  // the first step. Trees stand for their surfaces; simple shapes are solid. The first query after a step or a change
  // takes O(n log n) for n parts, and asks the source for the states of the bodies that the step has not asked for.
  // Later queries take O(log n) plus the cost of the parts that they examine. Results are correct to rounding in
  // double; bodies with invalid states are not found. Nothing is found if a number is not finite (a ray may be
  // infinitely long), a direction is 0 or a radius is negative, or from within a source or filter. Throws
  // std::bad_alloc only, and changes nothing.
  std::optional<WorldPoint> cast_ray(const Ray& ray, const QueryFilter& filter = {});
  // Returns the nearest point of any body, if it is at most `limit` away.
  std::optional<WorldPoint> nearest(const Vec3& point, double limit = std::numeric_limits<double>::infinity(),
                                    const QueryFilter& filter = {});
  // Returns the bodies that a solid sphere touches, in ascending order of indices. The span is valid until the next
  // query.
  std::span<const BodyId> touching_sphere(const Vec3& center, double radius, const QueryFilter& filter = {});

  // Predicts the cost of the steps after the last one from what the broad phase knows: loads[i] is that of the i-th
  // step after it. Fills at most 254 elements and returns their number.
  std::size_t predict_load(std::span<StepLoad> loads) const noexcept;

  std::uint64_t motion_bound_violations() const noexcept;             // Found so far (watch).
  std::uint64_t motion_bound_violations(BodyId body) const noexcept;  // Those of one body.
  std::size_t memory_bytes() const noexcept;                          // On the heap, without the shapes' trees.

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orchard::runtime
