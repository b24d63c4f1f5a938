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

namespace orchard::runtime {

// Where a body's values lie in the application's arrays: small numbers; the one given back last is used again first.
using BodyIndex = std::uint32_t;
inline constexpr BodyIndex kNoIndex = 0xffffffffu;
inline constexpr BodyIndex kMaxBodies = (1u << 28) - 1;

// A body, and no other: an index that is used again comes with another generation. So what still names a body that was
// removed is refused, and never meant for its successor.
struct BodyId {
  BodyIndex index = kNoIndex;
  std::uint32_t generation = 0;
  friend bool operator==(const BodyId&, const BodyId&) = default;
};
inline constexpr BodyId kNoBody{};

// Which pairs there are, in Box2D's terms: two bodies may be a pair if each one's mask has a bit of the other's
// category; but two of the same group, unless it is 0, always are if it is positive, and never if it is negative.
// Bullet's group and mask are `category` and `mask`; of Jolt's layers each gets a category. What is one body for the
// application, and several spheres for the broad phase, gets a negative group of its own: its parts are no pairs and
// keep no body awake.
struct BodyFilter {
  std::uint32_t category = 1;        // bits: what the body is
  std::uint32_t mask = 0xffffffffu;  // bits: the categories it has pairs with
  std::int32_t group = 0;
  bool ignores_static = false;  // it has no pairs with static bodies
  friend bool operator==(const BodyFilter&, const BodyFilter&) = default;
};

// Of two bodies of which none is static, or that do not ignore these.
constexpr bool may_pair(const BodyFilter& a, const BodyFilter& b) noexcept {
  if (a.group == b.group && a.group != 0) return a.group > 0;
  return (a.mask & b.category) != 0 && (b.mask & a.category) != 0;
}

// A filter of the application: the two bodies are no pair if it returns false. It is called for bodies that may_pair()
// allows, with a.index < b.index, whenever they are found near each other and whenever that is tested again, so it must
// return the same value for the same bodies until another filter is set. It is called from within advance() only (of a
// Detector: step()). What it asks of the same object is refused: see MotionSource.
using PairFilter = std::function<bool(BodyId a, BodyId b)>;

struct BodyPair {
  BodyIndex a, b;                                                       // a < b
  friend auto operator<=>(const BodyPair&, const BodyPair&) = default;  // NOLINT(modernize-use-nullptr): no 0 here
};

// Fills motions[i] with what is known of bodies[i] at `time`, the time of a step. A body may come up twice.
// A motion that is not valid (NaN, infinite, a negative radius, ..: see is_valid() in motion.h) is refused: the body is
// in no pair, is asked again at the next step, and is named in Advance::refused.
// While a source, a filter or a listener runs, the broad phase that called it refuses every change and every call of
// advance(), and its queries have no answer: they return what they return for a body that does not exist, and
// Advance::time_refused or BodyQueries::refused() is true. Destroying or moving the broad phase there is an error.
using MotionSource = std::function<void(double time, std::span<const BodyIndex> bodies, std::span<Motion> motions)>;

// For an application that keeps all motions as values, by BodyIndex, as of the time it calls advance() with. It calls
// advance() at every step then, which costs nothing while the broad phase sleeps. `values` outlives the broad phase and
// is longer than any index of a body that moves: static bodies have indices of the same kind, so bodies that were added
// after them need values beyond theirs. A body without a value is refused: see Advance::refused.
MotionSource values_of(const std::vector<Motion>& values);

// What an application knows of its bodies, by BodyIndex, that keeps it in floats, array by array, as of the time of
// advance(), as above: a third of the memory of as many motions, all of which an update of all windows passes through.
// BroadPhase::reading() takes them without a call in between. Positions are as long as there
// are bodies: one beyond the end of `x` is refused. Each of the others is as long, or empty: all 0, and `expiry` never.
// Floats are off by their last place. position_slack = float_slack() covers positions that are rounded to float when
// they are put here, kept_in_float() says what M and drift are where the state itself is kept so (motion_helpers.h).
struct MotionArrays {
  std::span<const float> x{}, y{}, z{};     // positions
  std::span<const float> vx{}, vy{}, vz{};  // velocities
  std::span<const float> radius{}, acceleration{}, drift{};
  std::span<const double> expiry{};
};

// A body that has not kept its bounds: `promise`, given at bound_time, does not allow what was given at `time`.
struct MotionBoundViolation {
  BodyId body;
  double bound_time, time;
  const Motion &bound, &given;
  MotionBoundExcess by;
};
// Called from within advance(), and within a query of BodyQueries; it calls nothing of the broad phase's.
using MotionBoundViolationListener = std::function<void(const MotionBoundViolation&)>;

struct BroadPhaseOptions {
  double time_step = 0.01;  // dt_d: the temporal resolution, in seconds; > 0
  double start = 0;         // the time of step 0
  // Most steps between two updates of a body's window; 0 lets the broad phase choose.
  std::uint32_t window = 0;
  // How far each position that the source gives may lie from one for which the bounds hold: for positions rounded to
  // float float_slack() in motion_helpers.h. A length; it costs what radii larger by twice as much would.
  double position_slack = 0;
  // For debugging: each motion that the source gives is compared with what it promised for the same body before, and
  // every moving body is asked for at every step that is processed, and at the last one not after the time of each
  // advance(). So what is not of the time it is asked for shows, too, as values of a frame that are taken for those of
  // a step. Pairs are the same as without; it costs what asking for all bodies costs, and 250 bytes for each. `broken`
  // hears of each broken promise, once: what was given instead counts from then on. Without it they are counted.
  bool validate = false;
  MotionBoundViolationListener broken{};
  // Updates of all windows of many bodies are cut into jobs of it. The same reports with any, or none; but the source
  // is called by several jobs at once then, each about its own bodies, and throws nothing. Steps within a budget, and
  // `validate`, take no part.
  Executor executor{};
  // Of so many bodies and more, or a quarter of them where enough pairs are near. Reports are the same with any; fewer
  // than some thousand are not worth waking a thread for, and a thread that is alone takes a tenth longer with jobs
  // where all fits into its cache.
  std::size_t min_bodies_for_jobs = 16384;
};

// Times are at most so many time steps before and after 0 (348 years at a step of 0.01 seconds): beyond, rounding would
// blur the steps.
inline constexpr double kMaxSteps = 0x1p40;

// time_step is from 1e-20 to 1e20, position_slack from 0 to kMaxNumber, and start is a time: not NaN, not infinite,
// within kMaxSteps time steps. A BroadPhase with other options refuses all bodies and all times.
bool is_valid(const BroadPhaseOptions& options) noexcept;

// A unit of a Budget's work is a motion that is asked for (8.2). A call asks for at least one of them. A pair's test
// takes two and is not split, so a step may ask for one more than the budget allows. The clock is read once per
// kWorkPerClock units.
inline constexpr std::uint64_t kWorkPerClock = 64;
inline constexpr std::uint64_t kWholeStep = std::numeric_limits<std::uint64_t>::max();

inline constexpr unsigned kNoClass = 256;

struct Advance {
  double time;                      // of the step that the pairs belong to; without pairs: nothing touches at any step
                                    // before this one, and there is no need to call again earlier
  std::span<const BodyPair> pairs;  // in ascending order; valid until the next call of any other member
  // Interrupted: pairs with a body of this importance class or a higher one may be missing. kNoClass: none is.
  unsigned incomplete_from = kNoClass;
  std::size_t left_over = 0;  // bodies and pairs that could not be asked for within the budget; 0: nothing is missing
  // Bodies whose motions were not valid at one of the steps that this call processed: they were in no pair there. In
  // ascending order; valid as long as the pairs.
  std::span<const BodyIndex> refused{};
  // Nothing was done: t_now is NaN, infinite or too far away (kMaxSteps), or the call came from a callback.
  bool time_refused = false;
  std::uint64_t work = 0;  // of the last step processed within a budget, in its units
};

// What the broad phase already knows of a step to come (8.2: the load, predicted).
struct StepsAhead {
  std::size_t updates = 0;   // bodies to be updated: a motion each
  std::size_t meetings = 0;  // pairs whose bounds can touch from that step on: two motions each
  std::size_t overlaps = 0;  // pairs that overlapped at the last step: they may do so still
};

class BroadPhase;

namespace detail {  // not for applications: the private header broad_phase/broad_phase_algorithm.h says what they are
class BroadPhaseAlgorithm;
class BodyPool;
using MakeMethod =
    std::function<std::unique_ptr<BroadPhaseAlgorithm>(BodyPool& pool, const BroadPhaseOptions& options)>;
BroadPhase make_broad_phase(MotionSource source, const BroadPhaseOptions& options, const MakeMethod& make);
}  // namespace detail

// Tells which bodies' bounding spheres overlap, and until when nothing can happen, from bounds on their motion
// (dissertation, chapter 4).
//
// Time passes in steps of dt_d = options.time_step; step k is at start + k dt_d. At each step the pairs reported are
// *exactly* those with spheres_touch() for the motions of that step, provided that the motions have kept their bounds
// since they were asked for (or cancel() was called). Hence: an overlap that lasts for dt_d or longer contains a step,
// and is reported at the first one, so less than dt_d after it begins. A shorter one may fall between two steps. Two
// static bodies are never a pair, nor are two that the filters exclude: such a pair is not made, and costs nothing but
// finding once per window update that the two are near.
//
// A bound that expires at a step's time still holds at this step. Where most bounds expire together and advance() is
// called when the new ones can be given already, half of the work is done at the step before the one that needs it.
//
// Call advance(t_now) once per frame, or more often, or when the time it returned has come, never with a smaller time:
//     for (Advance now = world.advance(t); !now.pairs.empty(); now = world.advance(t)) ..     // see Fig. 4.23
// While pairs overlap, each step reports them.
//
// Deterministic: same calls, same motions, same reports in the same order, on every machine, whatever a budget
// cut short in *work* leaves out. Not thread-safe.
//
// Throws only std::bad_alloc, and what the source throws. Where a change of bodies throws, nothing has changed. Where
// advance() throws, what it was about is lost: valid() is false from then on, there are no bodies, and all is refused.
class BroadPhase {
 public:
  // Keeps an event for each near pair, at the first step at which its two bounds can touch. Without a source there can
  // be static bodies only.
  explicit BroadPhase(MotionSource source, const BroadPhaseOptions& options = {});
  // The same with motions in arrays. `arrays` outlives the broad phase; its spans may become others between calls.
  static BroadPhase reading(const MotionArrays& arrays, const BroadPhaseOptions& options = {});
  BroadPhase(BroadPhase&&) noexcept;
  BroadPhase& operator=(BroadPhase&&) noexcept;
  ~BroadPhase();

  // What changes between two calls of advance() takes part from the first step after the time of the last report.
  // importance: 0 is the highest class. kNoBody if there are kMaxBodies already, or no source.
  BodyId add(std::uint8_t importance = 0, const BodyFilter& filter = {});
  // Never asked for again. Takes the position and the radius; kNoBody if the motion is not valid, too.
  BodyId add_static(const Motion& place, std::uint8_t importance = 0, const BodyFilter& filter = {});
  // The following change nothing and return false if there is no such body (any more).
  bool remove(BodyId body);
  // 4.4: the bounds last given for the body no longer hold from now on; they are asked for again at the next step.
  bool cancel(BodyId body);
  bool teleport(BodyId body) { return cancel(body); }         // the source gives the new place from now on
  bool move_static(BodyId body, const Motion& place);         // false, too, if it is not static or the motion not valid
  bool set_importance(BodyId body, std::uint8_t importance);  // from the next step
  bool set_filter(BodyId body, const BodyFilter& filter);  // from the next step; costs an update of the body's window

  BodyFilter filter_of(BodyId body) const noexcept;  // that of no body: BodyFilter{}
  // None: all pairs that may_pair() allows. From the next step; costs an update of each body's window.
  void set_pair_filter(PairFilter filter);

  BodyId id_of(BodyIndex index) const noexcept;  // of the body that has the index now; kNoBody: none
  bool contains(BodyId body) const noexcept { return body != kNoBody && id_of(body.index) == body; }

  // Processes the steps up to t_now that may have something, and stops at the first one that has. A long time ahead
  // takes a long time: a body is updated every 254 steps at least.
  Advance advance(double t_now) {
    if (!sleeps_until(t_now)) return process(t_now, nullptr, 0);
    seen_time_ = t_now > seen_time_ ? t_now : seen_time_;
    return {next_time_, {}};
  }
  // The same, within a budget per step: the bodies and pairs of the more important classes come first; what is left
  // over is resumed at the next step. Any budget gets to every body and pair of a class in time, unless a more
  // important class takes it all. Each pair reported was tested at this step.
  // `replay`, if not 0, replays what a clock has cut short: the step ends where that of another run did, in place of
  // budget.time. It is that run's Advance::work if the step was interrupted, else kWholeStep.
  Advance advance(double t_now, const Budget& budget, std::uint64_t replay = 0) {
    if (!sleeps_until(t_now)) return process(t_now, &budget, replay);
    seen_time_ = t_now > seen_time_ ? t_now : seen_time_;
    return {next_time_, {}};
  }

  // Leaves out the steps before the last one that is not after t, which becomes the next one that is processed: for an
  // application that was paused. Costs an update of every body's window at that step, however long the pause. Does
  // nothing, and returns 0, if nothing is due in between; else returns how many steps are left out.
  std::uint64_t skip_to(double t);

  // steps[i] becomes what is due at the i-th step after `time`, up to which steps have been processed. What has been
  // cancelled since is not in it, what has become void is: an estimate. Returns how many are known, at most 254; 0 for
  // other methods than the default one. O(what is due).
  std::size_t predict_load(double time, std::span<StepsAhead> steps) const noexcept;

  bool valid() const noexcept { return max_time_ >= 0; }    // the options are, and no step has thrown
  double next_time() const noexcept { return next_time_; }  // nothing happens before
  std::size_t size() const noexcept;                        // bodies
  std::size_t memory_bytes() const noexcept;                // held on the heap
  std::uint64_t motions_asked() const noexcept;             // of the source, so far
  std::uint64_t motion_bound_violations() const noexcept;   // found by BroadPhaseOptions::validate, so far

 private:
  struct State;
  friend class BodyQueries;  // broad_queries.h
  class Busy;
  bool may_change() const noexcept;
  friend BroadPhase detail::make_broad_phase(MotionSource source, const BroadPhaseOptions& options,
                                             const detail::MakeMethod& make);
  BroadPhase(MotionSource source, const BroadPhaseOptions& options, const detail::MakeMethod& make,
             const MotionArrays* arrays = nullptr);
  Advance process(double t_now, const Budget* budget, std::uint64_t replay);
  Advance process_steps(double t_now, const Budget* budget, std::uint64_t replay);
  BodyId add_body(std::uint8_t importance, const BodyFilter& filter, const Motion* place);
  bool sleeps_until(double t) const noexcept { return t < wake_time_ && std::fabs(t) <= max_time_; }
  std::int64_t step_reported() const noexcept;
  void validate_up_to(std::int64_t step);
  void wake_for_change();
  void note_next_step();

  std::unique_ptr<State> state_;
  double next_time_ = 0;  // of the next step with anything to do
  double wake_time_ = 0;  // the same, a rounding error earlier
  double max_time_ = -1;  // in size; below 0: no time is accepted
  double seen_time_ = 0;  // up to when everything has been reported
};

}  // namespace orchard::runtime
