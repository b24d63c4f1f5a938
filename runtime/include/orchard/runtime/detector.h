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

// The whole detector of the dissertation's Fig. 3.2 in one object: broad phase, narrow phase, and a schedule that keeps
// to a budget.
//
//   Detector world({.time_step = 1.0 / 60});
//   const ShapeId hull = world.load_shape("hull.orchard");
//   const BodyId ship = world.add_body(hull, {.velocity = {1, 0, 0}});
//   while (running) {
//     for (const PairEvent& event : world.step(time, {.work = 100'000}).events) respond(event);    // set_velocity(..)
//   }
namespace orchard::runtime {

// A shape that parts of bodies have: any number of bodies may share it. Shapes are never removed.
using ShapeId = std::uint32_t;
inline constexpr ShapeId kNoShape = 0xffffffffu;

// Half-spaces have indices of their own: the first one that is added has kFirstHalfSpace, the next one the next, and
// none is used again. All other bodies have indices below kMaxBodies, which are used again once a body is removed. So
// an array by BodyId::index holds bodies, and one by half_space_number() half-spaces.
inline constexpr BodyIndex kFirstHalfSpace = 0xf0000000u;
constexpr bool is_half_space(const BodyId& body) noexcept {
  return body.index >= kFirstHalfSpace && body.index != kNoIndex;
}
// 0 for the half-space that was added first. Precondition: is_half_space(body).
constexpr std::uint32_t half_space_number(const BodyId& body) noexcept { return body.index - kFirstHalfSpace; }

// A rigid part of a body: world = the body's pose after `local`. Lengths of a shape times local.scale times the body's.
struct BodyPart {
  ShapeId shape = kNoShape;
  Pose local{};
};

// What the application knows of a body at the time of a step. The promise is about the body's origin, pose.translation:
// see Motion in motion.h, whose fields these are. The scale stays what it is until the promise expires. A state with a
// pose and a velocity and nothing else promises that the body flies straight on for ever. DetectorOptions::watch, which
// is on by default where a source gives the states, finds at every step what has not kept its promise.
struct BodyState {
  Pose pose{};
  Vec3 velocity{};
  double acceleration = 0;
  double drift = 0;
  Vec3 half_space{};
  double expiry = std::numeric_limits<double>::infinity();
  // At most, until the promise expires, in radians per second. Worth telling of bodies whose origin is not in their
  // middle: one of which nothing is promised (infinity) may soon have its farthest point on any side of its origin.
  // Not negative.
  double angular_speed = std::numeric_limits<double>::infinity();
};

// Fills states[i] with what is known of bodies[i] at `time`, the time of a step. It throws nothing. Called from within
// step() only, in the thread that called this. While a source, a filter or a listener runs, the detector that called it
// refuses every change and every call of step(), manifold() and predict_load(): they return what they return for a body
// that does not exist, and Frame::time_refused is true. Destroying or moving the detector there is an error.
using StateSource = std::function<void(double time, std::span<const BodyIndex> bodies, std::span<BodyState> states)>;

// For an application that keeps all states as values, by BodyIndex, as of the time it calls step() with. The vector
// outlives the detector and is longer than any index of a body that moves: static bodies have indices of the same kind,
// so bodies that were added after them need values beyond theirs. A body without a value is in no pair: see
// Frame::refused.
StateSource states_of(const std::vector<BodyState>& values);

struct BodyOptions {
  std::uint8_t importance = 0;  // 0 is the highest class; a pair is as important as the less important of its bodies
  // Which pairs the body is in. Others are no pair in the broad phase already, and cost nothing. Half-spaces are
  // static.
  BodyFilter filter{};
  // Above 0: also what happens between two steps is found, by time_of_impact() from pose to pose, those of the body and
  // of its parts: of each part the centre straight, the rotation by the smallest angle. It is a promise that relative
  // to whatever the body may meet no origin moves faster. Lengths per second. Where the scale changes within a step,
  // the answer is "possible".
  double continuous_speed = 0;
  // The body, whatever its parts do, lies within this distance of its origin at scale 1: saves a new window update
  // whenever an articulated body stretches. 0: as far as the parts reach.
  double reach = 0;
  // The source gives poses, and a velocity if it has one: acceleration, drift, half-space and expiry are suggested by
  // the motion monitor. add_body() refuses it where DetectorOptions::watch is off, since a guess has to be checked.
  bool suggest = false;
};

// An observer, for debugging and visualisation: what the broad phase relies on from `time` on, until it asks for the
// body again. The motion is of the body's origin, or where BodyState::angular_speed allows it, of its middle.
using MotionBoundListener = std::function<void(double time, BodyIndex body, const Motion& bound)>;

struct DetectorOptions {
  double time_step = 0.01;    // dt_d, see BroadPhaseOptions; > 0. Usually a frame
  double start = 0;           // the time of step 0
  double position_slack = 0;  // see BroadPhaseOptions
  // Whether every moving body's state is asked for at every step and compared with what was promised (4.4). A promise
  // that does not hold is then cancelled in time for this very step, counted, and named in Frame::broken: nothing is
  // missed. Without it a body is only asked for when something depends on it, which costs less
  // (docs/guide/detector.md), and contacts are missed in silence unless every promise is kept or cancel() is called.
  // Empty: on with a state source, off where the detector keeps the states, as set_state() cancels what it changes.
  std::optional<bool> watch{};
  // An "end" comes after so many steps in a row with a certain "no"; at least 1. What trembles at contact may use more.
  std::uint32_t steps_to_end = 1;
  // Pairs of trees that may be gone on with after a first piece at once; what exceeds it is reported as possible.
  std::size_t max_unfinished = 4096;
  // A call of step() ends early after the step with which it has so many events or more, so that its memory does not
  // grow with the length of a pause: see Frame::steps_left. At least 1.
  std::size_t max_events = std::size_t{1} << 18;
  // Pairs of large trees that stay close, and are expensive to search each time, get a front each (PairFront, 43 KB):
  // so many at most, made as such pairs come near each other. 0: none.
  std::size_t max_fronts = 64;
  // Pairs, poses, events, and where many bodies are in pairs the broad phase's windows; the same answers with any.
  // Sources and filters are called in the thread that calls step(), all the same.
  Executor executor{};
  // Called from within step(), whenever the broad phase is given a body's motion. It throws nothing.
  MotionBoundListener bound_given{};
};

// How far a step got that a budget in time cut short.
struct StepCut {
  std::uint64_t broad = kWholeStep;    // the replay of BroadPhase::advance()
  std::uint64_t begun = kWholeStep;    // beginnings of pairs of parts, and first searches
  std::uint64_t refined = kWholeStep;  // their work, and 1 for each piece of it
  std::uint64_t swept = kWholeStep;    // pairs
  friend bool operator==(const StepCut&, const StepCut&) = default;
};

// A unit of a Budget's work is that of NarrowPhase; a motion that the broad phase asks for counts as kMotionWork,
// beginning a pair as kPairWork, one with a simple shape as kSimplePairWork. The broad phase gets half of a limited
// budget at most, sweeps half of what it leaves. Of a budget in time, what a step does in any case is foreseen from the
// steps before, and set aside; where that alone takes longer, nothing keeps the step to its budget. A step exceeds
// `work` by less than kMaxOvershoot, one pair of leaves, but for what each step does in any case: one unit of the broad
// phase. Only a budget in counted work gives the same answers on every machine; what a clock has cut short can be
// replayed.
inline constexpr std::uint64_t kMotionWork = 16;
inline constexpr std::uint64_t kPairWork = 16;
inline constexpr std::uint64_t kSimplePairWork = 64;
inline constexpr std::uint64_t kMaxOvershoot = std::uint64_t{kLeafPairTests} * kTriangleTestCost + kBlockWidth;

struct StepOptions {
  // Not null: the step ends where that of another run did, Frame::cut, in place of the budget's time. After the same
  // calls with the same states, the frame is that run's. A replayed call answers one step at most, and no executor took
  // part.
  const StepCut* replay = nullptr;
  // Only the last step up to the time given to step() is answered, for after a pause. The steps before it are left out:
  // their number is Frame::skipped, what only happened there is not reported, and no sweep of a continuous body leads
  // across them. What touched before and touches now stays, what touches no more ends.
  bool latest_only = false;
};

enum class PairChange : std::uint8_t {
  begin,     // the first certain yes
  stay,      // touching since an earlier step: no certain no since
  end,       // the certain no after a begin (the last one of steps_to_end), or a body was removed or teleported
  possible,  // neither touching nor certainly apart at this step: the budget ended, or nothing more can be known
};

// One pair at one step. a.index < b.index, but for half-spaces, which are always b.
struct PairEvent {
  PairChange change = PairChange::possible;
  BodyId a, b;
  std::uint32_t part_a = 0, part_b = 0;  // that touch, or with the least bound
  double time = 0;                       // of the step
  Verdict verdict;  // what is certain at this step. `stay` may have "maybe", or "no" while steps_to_end counts
  // Of a contact between the step before and this one (continuous bodies): begins in this bracket. NaN: not such a one.
  double impact_from = std::numeric_limits<double>::quiet_NaN();
  double impact_to = std::numeric_limits<double>::quiet_NaN();
};

// What step() found. The spans are valid until the next call of a member that is not const.
struct Frame {
  double time = 0;          // of the last step that was answered
  double next_time = 0;     // nothing can begin or end before: no need to call earlier
  std::uint32_t steps = 0;  // answered in this call
  // Up to the time given: not 0 if DetectorOptions::max_events ended the call, and another one with the same time goes
  // on.
  std::uint64_t steps_left = 0;
  std::uint64_t skipped = 0;            // steps left out: StepOptions::latest_only
  std::span<const PairEvent> events;    // by time, then by pair
  std::uint64_t pairs = 0;              // of bodies that may touch, whose spheres overlapped, over the steps
  std::uint64_t certain = 0;            // of these, with a certain answer
  StepCut cut{};                        // the last step's, if the budget was in time and there is no executor
  double worst_bound = 0;               // the largest separation bound among the rest: how far from certain
  std::uint64_t work = 0;               // in units of Budget::work
  std::uint64_t motions_asked = 0;      // part of it: times kMotionWork
  unsigned incomplete_from = kNoClass;  // the broad phase was interrupted: see Advance
  std::size_t left_over = 0;
  // States that were not valid, or poses not rigid: such a body is in no pair at that step, or, if its promise held on,
  // in pairs that are possible.
  std::span<const BodyIndex> refused;
  std::span<const BodyIndex> broken;  // promises that did not hold; cancelled (watch)
  bool time_refused = false;          // see Advance: nothing was done, or step() was called from within itself
  // There was not enough memory for what this step needs. The detector answers nothing from then on: make another one.
  bool out_of_memory = false;
};

// What the next steps are likely to cost, from the broad phase's own timing wheel of events (8.2).
struct StepLoad {
  double time = 0;
  std::uint64_t motions = 0;  // to be asked for, at least
  double pairs = 0;           // expected to overlap
  double work = 0;            // expected, in units of Budget::work
};

// What a question about all bodies of a world has found.
struct WorldPoint {
  BodyId body;
  std::uint32_t part = 0;
  double distance = 0;  // from the point asked about, 0 inside a solid; along a ray, in lengths of its direction
  Vec3 point{};         // of the body; of a ray that begins inside a solid, its origin
  std::uint32_t triangle = kNoTriangle;  // of trees
};

// Which bodies touch, at every step, within a budget, always with a bound.
//
// At each step every pair of bodies whose spheres overlap, that the filters allow, is answered from
// the poses of that step: yes, no, or maybe with bounds. Bodies of several parts touch iff two of their parts do; where
// many static bodies are in reach of one, the spheres that have to overlap are its parts'. The parts of one body are
// never a pair, nor are two static bodies. Trees are their surfaces, as for NarrowPhase; the simple shapes (sphere,
// capsule, box, half-space) are solid.
//
// Refinement (7.3): by class of importance, and within a class those first that have waited longest for a certain
// answer. All pairs begin with what tells most of them at next to no cost: spheres, roots, what the last step found.
// At the same time, with a share that no budget takes from them, the others go straight to their triangles, one after
// the other, in pieces; who is not finished then gets further ones, each four times the last. Bounds of pairs that are
// not certain are those of their spheres, or better. So under any budget every pair gets its turn.
//
// Deterministic: same calls, same states, same budget in work: same frames, with any executor. A pair's answer without
// budget does not depend on other pairs. Allocates nothing once warm: once as many bodies, pairs and kinds of pairs as
// there are have been there before. step() throws nothing; the other members throw only std::bad_alloc, and then the
// detector has no bodies and answers nothing any more: see Frame::out_of_memory. One object
// belongs to one thread at a time.
class Detector {
 public:
  // The detector keeps the states of bodies, and moves them: see set_state().
  explicit Detector(const DetectorOptions& options = {});
  // The application knows where its bodies are, and is asked when something depends on it.
  explicit Detector(StateSource source, const DetectorOptions& options = {});
  Detector(Detector&&) noexcept;
  Detector& operator=(Detector&&) noexcept;
  ~Detector();

  // Shapes. kNoShape if structure_fault(tree), or a number is not finite, or a length is negative (a half-length of 0
  // is a flat box). Trees outlive the detector, unchanged but for what FlexibleTree does between steps.
  ShapeId add_shape(const TreeView& tree);
  // A tree of its own. kNoShape if there is no such file, or no tree in it; `status` says why.
  ShapeId load_shape(const char* path, LoadStatus* status = nullptr);
  ShapeId add_sphere(double radius, const Vec3& center = {});
  ShapeId add_capsule(const Vec3& p, const Vec3& q, double radius);  // the points within `radius` of the segment
  ShapeId add_box(const Vec3& half_lengths);                         // around the origin, along the axes

  // Bodies. What changes between two steps takes part from the next one. kNoBody if a part's shape is none or its pose
  // not rigid, if there are no parts, if there are kMaxBodies, or the options are not valid, `suggest` without `watch`
  // among them.
  BodyId add_body(std::span<const BodyPart> parts, const BodyOptions& options = {});
  BodyId add_body(std::initializer_list<BodyPart> parts, const BodyOptions& options = {}) {
    return add_body(std::span(parts.begin(), parts.size()), options);
  }
  // Of one part, where the detector keeps the states (else kNoBody): there, and moving on, from the last step on.
  BodyId add_body(ShapeId shape, const BodyState& state, const BodyOptions& options = {});
  // Never asked for.
  BodyId add_static(std::span<const BodyPart> parts, const Pose& pose, const BodyOptions& options = {});
  BodyId add_static(std::initializer_list<BodyPart> parts, const Pose& pose, const BodyOptions& options = {}) {
    return add_static(std::span(parts.begin(), parts.size()), pose, options);
  }
  // Everything with normal . point <= offset; the normal of any length but 0. See half_space_number(). Costs nothing
  // for bodies that cannot reach it: each has an event of its own, like the broad phase's.
  BodyId add_half_space(const Vec3& normal, double offset, const BodyOptions& options = {});

  // The following change nothing and return false if there is no such body, or what is handed over is not valid.
  bool remove(BodyId body);
  bool cancel(BodyId body);    // the promise last given holds no longer
  bool teleport(BodyId body);  // the source gives the new place from now on; a touch ends, and no sweep leads there
  bool move_static(BodyId body, const Pose& pose);
  // Where the detector keeps the states. From the time of the last step on (before the first one: from `start`) the
  // body is there, and goes straight on at `velocity` without turning, until it is told otherwise. Without `watch` this
  // cancels what was promised; with it, only what does not hold is. A body that sleeps sleeps on, there.
  bool set_state(BodyId body, const BodyState& state);
  bool set_velocity(BodyId body, const Vec3& velocity);              // from where it is now
  bool set_local(BodyId body, std::size_t part, const Pose& local);  // articulated bodies: at any time
  bool set_importance(BodyId body, std::uint8_t importance);
  bool set_filter(BodyId body, const BodyFilter& filter);
  // It does not move until wake(): its source is asked once more, at the next step, and then no more. Pairs of it with
  // what does not move either keep their answers at no cost. Where the detector keeps the states it stops where it is,
  // and wakes at rest.
  bool sleep(BodyId body);
  bool wake(BodyId body);
  bool asleep(BodyId body) const noexcept;
  // The triangles of a shape's tree have moved (FlexibleTree): answers about bodies at rest are void. O(bodies).
  bool shape_changed(ShapeId shape);
  // None: all pairs. Pairs that overlap already are asked about again; see PairFilter in broad_phase.h.
  void set_pair_filter(PairFilter filter);
  void set_executor(const Executor& executor) noexcept;

  // At the time of the last step, where the detector keeps the states; else as of when it was asked for last. What is
  // static, half-spaces included, is at rest.
  BodyState state(BodyId body) const noexcept;
  bool moves(BodyId body) const noexcept;  // neither static nor a half-space
  // No point of the shape is farther from the shape's origin. 0: no such shape.
  double reach(ShapeId shape) const noexcept;
  bool contains(BodyId body) const noexcept;
  std::size_t size() const noexcept;  // bodies, half-spaces included
  bool valid() const noexcept;        // the options are

  // Answers the steps up to `time` that may have something, in order; what the budget has left is shared evenly among
  // them. Call it once per frame, never with a smaller time. A long time ahead takes a long time, as every step with a
  // pair, and with `watch` every step, is looked at, within any budget: StepOptions::latest_only answers the last one
  // alone.
  Frame step(double time, const Budget& budget = {}, const StepOptions& options = {}) noexcept;

  // Where the parts of an event of the last step touch, at up to four points, and how they come apart; as contacts()
  // does for two trees. Boxes are solid: what is wholly inside one leaves it. With a half-space the points are the
  // outermost ones of where the surface cuts its plane (of a capsule, the lowest points of its ends), and the depth is
  // that of the lowest point. Of spheres and capsules with anything else there is one point, and the depth is that
  // along the normal.
  // Without points, and "maybe", if the event's bodies are gone or its answer is not yes. For a contact between two
  // steps it tells of this step, at which it may be over: "no". Allocates nothing once warm; throws nothing.
  Manifold manifold(const PairEvent& event, const ContactOptions& options = {}) noexcept;

  // All bodies, half-spaces included, as of the time of the last step (before the first one: of `start`). Trees are
  // their surfaces, simple shapes are solid. The first question after a step or a change costs O(n log n) for n parts,
  // and the source gives the states, for that time, of the bodies that the step has not asked for; the next ones cost
  // O(log n) parts, and what each asks about. Answers are correct to rounding in double; bodies whose states are not
  // valid are not found. Nothing is found if a number is not finite (a ray may be infinitely long), a direction 0, or a
  // radius negative, nor from within a source or filter. Throws std::bad_alloc only, and changes nothing.
  // The first point of any body that the ray meets; of equal ones that of the smallest index.
  std::optional<WorldPoint> cast_ray(const Ray& ray, const QueryFilter& filter = {});
  // The point of any body that is nearest, if it is no farther than `limit`.
  std::optional<WorldPoint> nearest(const Vec3& point, double limit = std::numeric_limits<double>::infinity(),
                                    const QueryFilter& filter = {});
  // The bodies that a solid sphere touches, in ascending order of indices. Until the next question.
  std::span<const BodyId> touching_sphere(const Vec3& center, double radius, const QueryFilter& filter = {});

  // What the steps after the last one will cost, as far as the broad phase knows now: loads[i] is that of the i-th step
  // after it. At most 254 are filled; returns how many.
  std::size_t predict_load(std::span<StepLoad> loads) const noexcept;

  std::uint64_t motion_bound_violations() const noexcept;             // found so far (watch)
  std::uint64_t motion_bound_violations(BodyId body) const noexcept;  // of one body
  std::size_t memory_bytes() const noexcept;                          // held on the heap, shapes' trees not included

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orchard::runtime
