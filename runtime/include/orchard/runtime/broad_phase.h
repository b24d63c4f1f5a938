#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "orchard/runtime/execution.h"
#include "orchard/runtime/motion.h"

// The broad phase: which bodies' bounding spheres overlap, from bounds on their motion.
namespace orchard::runtime {

// The number of a body, which is the index of its values in the arrays of the application. Numbers are small: that of a
// removed body is reused, the last removed one first.
using BodyIndex = std::uint32_t;
inline constexpr BodyIndex kNoIndex = 0xffffffffu;
inline constexpr BodyIndex kMaxBodies = (1u << 28) - 1;

// Identifies one body uniquely: each time an index is reused, it has another generation. So the id of a removed body is
// refused, and never refers to the body that has the index now.
struct BodyId {
  BodyIndex index = kNoIndex;
  std::uint32_t generation = 0;
  friend bool operator==(const BodyId&, const BodyId&) = default;
};
inline constexpr BodyId kNoBody{};

// Which pairs a body is in, in Box2D's terms. Two bodies may be a pair if each one's mask has a bit of the other's
// category. Two bodies of the same group other than 0 are always a pair if the group is positive, never if negative.
// Bullet's group and mask are `category` and `mask`; each of Jolt's layers becomes a category. If one body of the
// application is several spheres of the broad phase, give these a negative group of their own: then they form no pairs
// with each other and keep no body awake.
struct BodyFilter {
  std::uint32_t category = 1;        // Bits: what the body is.
  std::uint32_t mask = 0xffffffffu;  // Bits: the categories that it has pairs with.
  std::int32_t group = 0;
  bool ignores_static = false;  // Whether it has no pairs with static bodies.
  friend bool operator==(const BodyFilter&, const BodyFilter&) = default;
};

// Returns whether the filters allow a pair, if neither body is static or neither filter ignores static bodies.
constexpr bool may_pair(const BodyFilter& a, const BodyFilter& b) noexcept {
  if (a.group == b.group && a.group != 0) return a.group > 0;
  return (a.mask & b.category) != 0 && (b.mask & a.category) != 0;
}

// A filter of the application: the two bodies are never a pair if it returns false. It is called for bodies that
// may_pair() allows, with a.index < b.index, whenever the two are found near each other. That happens repeatedly, so it
// must return the same value for the same bodies until another filter is set. Only advance() (of a Detector: step())
// calls it. The object refuses calls from within the filter: see MotionSource.
using PairFilter = std::function<bool(BodyId a, BodyId b)>;

// Two bodies whose bounding spheres overlap.
struct BodyPair {
  BodyIndex a, b;                                                       // a < b
  friend auto operator<=>(const BodyPair&, const BodyPair&) = default;  // NOLINT(modernize-use-nullptr): no 0 here
};

// A callback that fills motions[i] with what is known of bodies[i] at `time`, the time of a step. A body may occur
// twice. A motion that is not valid (NaN, infinite, a negative radius, ..: see is_valid() in motion.h) is refused: the
// body is in no pair, is asked for again at the next step, and is named in Advance::refused. While a source, a filter
// or a listener runs, the broad phase that called it refuses every change and every call of advance(), and its queries
// have no answer: they return what they return for a body that does not exist, and Advance::time_refused or
// BodyQueries::refused() is true. Destroying or moving the broad phase there is an error.
using MotionSource = std::function<void(double time, std::span<const BodyIndex> bodies, std::span<Motion> motions)>;

// Returns a source that reads the motion of body i from values[i]. The application keeps these values up to date: they
// hold at the time that it passes to advance(). It must then call advance() at every step, which costs nothing while
// nothing can happen. `values` must outlive the broad phase and have an element for the index of each moving body.
// Static bodies use indices, too. A body without a value is refused.
MotionSource values_of(const std::vector<Motion>& values);

// A motion that does not keep the bounds that were given before for the same body: the bounds of `bound`, which held
// from bound_time on, do not allow the motion `given` at `time`.
struct MotionBoundViolation {
  BodyId body;
  double bound_time, time;
  const Motion &bound, &given;
  MotionBoundExcess by;  // By how much each bound is exceeded.
};
// Called by advance() and by queries of BodyQueries. It must not call the broad phase.
using MotionBoundViolationListener = std::function<void(const MotionBoundViolation&)>;

// The options of a BroadPhase.
struct BroadPhaseOptions {
  double time_step = 0.01;  // The temporal resolution dt_d in seconds, above 0.
  double start = 0;         // The time of step 0.
  // The maximum number of steps between two updates of a body's window; 0 lets the broad phase choose.
  std::uint32_t window = 0;
  // The largest error (a length) of the positions that the source gives: their distance from exact ones that keep the
  // bounds. Rounding to float: see float_slack() (motion_helpers.h). It costs as much as radii larger by twice this.
  double position_slack = 0;
  // For debugging: compares each motion that the source gives with the bounds that it gave before for the same body.
  // Every moving body is asked for at every processed step, and at the last step that is not after the time of each
  // advance(). This also finds motions that do not belong to the time that was asked for, such as values of a frame
  // passed as values of a step. The pairs do not change. The cost is that of asking for all bodies, and 250 bytes for
  // each. The listener `broken` receives each violation once; the bounds of the new motion then replace the violated
  // ones. motion_bound_violations() counts them, with and without a listener.
  bool validate = false;
  MotionBoundViolationListener broken{};
  // Runs updates of all windows of many bodies as jobs. Reports are the same with any executor or none. The source is
  // then called by several jobs at once, each for its own bodies, and must not throw. Steps within a budget and
  // `validate` do not use the executor.
  Executor executor{};
  // The smallest number of updated bodies for which the executor is used. Reports do not depend on it. Lower values pay
  // only from some thousand bodies on, because waking a thread takes time; and if a single thread runs all jobs and
  // everything fits into its cache, jobs cost a tenth more.
  std::size_t min_bodies_for_jobs = 16384;
};

// The most time steps between a time and 0 (348 years at a step of 0.01 s). Beyond it, rounding would blur the steps.
inline constexpr double kMaxSteps = 0x1p40;

// Returns whether time_step is in 1e-20..1e20, position_slack in 0..kMaxNumber, and start finite and within kMaxSteps
// steps. A BroadPhase with other options refuses all bodies and all times.
bool is_valid(const BroadPhaseOptions& options) noexcept;

// The number of units of work between two readings of the clock. A unit of Budget::work is one motion that is asked for
// (8.2). A call asks for at least one. The test of a pair takes two units and is not split, so a step may exceed the
// budget by one unit.
inline constexpr std::uint64_t kWorkPerClock = 64;
// The value of `replay` in BroadPhase::advance() for a step that was not interrupted.
inline constexpr std::uint64_t kWholeStep = std::numeric_limits<std::uint64_t>::max();

// Stands for no class of importance; classes are 0 to 255.
inline constexpr unsigned kNoClass = 256;

// The result of advance().
struct Advance {
  // With pairs, the time of the step at which they overlap. Without pairs, no spheres touch at any step before this
  // time, and calling advance() earlier is unnecessary.
  double time;
  std::span<const BodyPair> pairs{};  // In ascending order; valid until the next call of any other member.
  // If the step was interrupted, pairs with a body of this importance class or above may be missing; kNoClass: none is.
  unsigned incomplete_from = kNoClass;
  std::size_t left_over = 0;  // Bodies and pairs that the budget left untested; 0: nothing is missing.
  // Bodies whose motions were not valid at a step that this call processed; they were in no pair there. In ascending
  // order; valid as long as the pairs.
  std::span<const BodyIndex> refused{};
  // Nothing was done, because t_now is not finite or beyond kMaxSteps, or because a callback called advance().
  bool time_refused = false;
  std::uint64_t work = 0;  // The units of work of the last step, if it was processed within a budget.
};

// The work of a future step, as far as the broad phase already knows it (8.2: predicted load).
struct StepsAhead {
  std::size_t updates = 0;   // Bodies whose windows will be updated. Each needs one motion.
  std::size_t meetings = 0;  // Pairs whose bounds can touch from this step on. Each needs two motions.
  std::size_t overlaps = 0;  // Pairs that overlapped at the last step and may still overlap.
};

class BroadPhase;

namespace detail {  // not for applications: the private header broad_phase/broad_phase_algorithm.h says what they are
class BroadPhaseAlgorithm;
class BodyPool;
using MakeMethod =
    std::function<std::unique_ptr<BroadPhaseAlgorithm>(BodyPool& pool, const BroadPhaseOptions& options)>;
BroadPhase make_broad_phase(MotionSource source, const BroadPhaseOptions& options, const MakeMethod& make);
}  // namespace detail

// Finds the pairs of bodies whose bounding spheres overlap, and the next time at which there can be such a pair, from
// bounds on their motion (dissertation, chapter 4).
//
// Time passes in steps of dt_d = options.time_step; step k is at start + k dt_d. At each step the reported pairs are
// *exactly* those with spheres_touch() for the motions of that step, provided that the motions have kept their bounds
// since they were asked for (or cancel() was called). So an overlap that lasts for dt_d or longer contains a step, and
// is reported at the first one, less than dt_d after it begins. A shorter one may fall between two steps. Two static
// bodies are never a pair, nor are two that the filters exclude; an excluded pair costs only the discovery, once per
// window update, that the two are near.
//
// A bound that expires at the time of a step still holds at this step. If most bounds expire together, all windows have
// to be updated at the next step. About half of this work is done one step ahead, if the source can already give bounds
// that hold at the next step.
//
// Call advance(t_now) once per frame, or more often, or at the time that it returned, with times that do not decrease:
//     for (Advance now = world.advance(t); !now.pairs.empty(); now = world.advance(t)) ..     // see Fig. 4.23
// While pairs overlap, each step reports them.
//
// The broad phase is deterministic: the same calls and motions give the same reports in the same order on every
// machine, also for steps that a budget in *work* cut short. It is not thread-safe.
//
// Throws only std::bad_alloc, and what the source throws. If a change of bodies throws, nothing has changed. If
// advance() throws, its result is lost: valid() is then false, there are no bodies, and all calls are refused.
class BroadPhase {
 public:
  // Constructs a broad phase that keeps an event for each near pair, at the first step at which the bounds of the two
  // can touch. Without a source there can be only static bodies.
  explicit BroadPhase(MotionSource source, const BroadPhaseOptions& options = {});
  BroadPhase(BroadPhase&&) noexcept;
  BroadPhase& operator=(BroadPhase&&) noexcept;
  ~BroadPhase();

  // Adds a moving body. `importance` is its class; 0 is the highest. Returns kNoBody if there are kMaxBodies bodies or
  // no source. Changes between two calls of advance() take effect at the first step after the time of the last report.
  BodyId add(std::uint8_t importance = 0, const BodyFilter& filter = {});
  // Adds a body that does not move. Only the position and the radius of `place` count, and the body is never asked for.
  // Returns kNoBody also if the motion is not valid.
  BodyId add_static(const Motion& place, std::uint8_t importance = 0, const BodyFilter& filter = {});
  // Removes a body. This function and the following ones change nothing and return false if there is no such body.
  bool remove(BodyId body);
  // Cancels the body's bounds, for example because it collided: the source is asked again at the next step (4.4).
  bool cancel(BodyId body);
  bool teleport(BodyId body) { return cancel(body); }  // The source gives the new place from now on.
  // Returns false also if the body is not static or the motion not valid.
  bool move_static(BodyId body, const Motion& place);
  bool set_importance(BodyId body, std::uint8_t importance);  // Takes effect from the next step.
  bool set_filter(BodyId body, const BodyFilter& filter);     // Likewise; costs an update of the body's window.

  BodyFilter filter_of(BodyId body) const noexcept;  // Returns BodyFilter{} if there is no such body.
  // Sets the filter of pairs; an empty function allows all pairs that may_pair() allows. It takes effect from the next
  // step and costs an update of each body's window.
  void set_pair_filter(PairFilter filter);

  BodyId id_of(BodyIndex index) const noexcept;  // Returns the body with this index now, or kNoBody.
  bool contains(BodyId body) const noexcept { return body != kNoBody && id_of(body.index) == body; }

  // Processes the steps up to t_now that may have a result, and stops at the first one that has. A long interval takes
  // long, because each body is updated at least every 254 steps.
  // The budget is that of each step, unlimited by default. The bodies and pairs of the more important classes come
  // first; the next step continues with those that the budget left over. Any budget reaches every body and pair of a
  // class eventually, unless a more important class uses all of it. Each reported pair was tested at this step.
  // `replay`, if not 0, repeats a step of another run that a limit of time interrupted: the step ends after the same
  // work instead of at budget.time. Pass the Advance::work of that run if the step was interrupted, otherwise
  // kWholeStep.
  Advance advance(double t_now, const Budget& budget = {}, std::uint64_t replay = 0) {
    if (!sleeps_until(t_now)) return process(t_now, budget.limited() || replay != 0 ? &budget : nullptr, replay);
    seen_time_ = t_now > seen_time_ ? t_now : seen_time_;
    return {next_time_, {}};
  }

  // Skips steps after a pause: the next step to be processed is the last one that is not after t. That step updates the
  // window of every body, however long the pause was. Returns the number of skipped steps. If nothing is due before
  // that step, it does nothing and returns 0.
  std::uint64_t skip_to(double t);

  // Predicts the load: writes to steps[i] the work of the i-th step after `time`, up to which steps have been
  // processed. It is an estimate: bodies that were cancelled since then are missing, and obsolete events are included.
  // Returns the number of steps that are known, at most 254; 0 for algorithms other than the default one. Its time is
  // proportional to these events.
  std::size_t predict_load(double time, std::span<StepsAhead> steps) const noexcept;

  bool valid() const noexcept { return max_time_ >= 0; }    // The options are valid, and no step has thrown.
  double next_time() const noexcept { return next_time_; }  // Nothing happens before this time.
  std::size_t size() const noexcept;                        // The number of bodies.
  std::size_t memory_bytes() const noexcept;                // On the heap.
  std::uint64_t motions_asked() const noexcept;             // Motions that the source has given so far.
  std::uint64_t motion_bound_violations() const noexcept;   // Violations found by BroadPhaseOptions::validate so far.

 private:
  struct State;
  friend class BodyQueries;  // broad_queries.h
  class Busy;
  bool may_change() const noexcept;
  friend BroadPhase detail::make_broad_phase(MotionSource source, const BroadPhaseOptions& options,
                                             const detail::MakeMethod& make);
  BroadPhase(MotionSource source, const BroadPhaseOptions& options, const detail::MakeMethod& make);
  Advance process(double t_now, const Budget* budget, std::uint64_t replay);
  Advance process_steps(double t_now, const Budget* budget, std::uint64_t replay);
  BodyId add_body(std::uint8_t importance, const BodyFilter& filter, const Motion* place);
  bool sleeps_until(double t) const noexcept { return t < wake_time_ && std::fabs(t) <= max_time_; }
  std::int64_t step_reported() const noexcept;
  void validate_up_to(std::int64_t step);
  void wake_for_change();
  void change_all();
  void note_next_step();

  std::unique_ptr<State> state_;
  double next_time_ = 0;
  double wake_time_ = 0;  // next_time_ less a rounding error.
  double max_time_ = -1;  // The largest accepted |time|; below 0: no time is accepted.
  double seen_time_ = 0;  // The time up to which everything has been reported.
};

}  // namespace orchard::runtime
