#pragma once
#include "detector/kept_states.h"
#include "detector/load_model.h"
#include "detector/part_search.h"
#include "detector/rounds.h"
#include "detector/step_pairs.h"
#include "orchard/runtime/detector.h"
#include "orchard/runtime/motion_monitor.h"

namespace orchard::runtime {

// Each group of functions is in the file that stands above it.
struct Detector::State {
  using Step = detail::Step;
  State(StateSource source, const DetectorOptions& wanted);
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  // detector.cpp
  // What `made()` gives. Where there is no memory for it, nobody knows what has been done.
  template <typename Make>
  auto or_fail(Make&& made) {
    struct FailsUnlessDone {
      bool& failed;
      bool done = false;
      ~FailsUnlessDone() { failed = failed || !done; }
    } until_done{failed};
    auto result = made();
    until_done.done = true;
    return result;
  }
  static void run_for_broad(void* context, std::size_t count, Executor::Job job, void* data);

  // change_bodies.cpp: bodies come, change and go between two steps
  detail::Body& take_in(BodyId id, std::span<const BodyPart> parts, const BodyOptions& with);
  bool acceptable(std::span<const BodyPart> parts) const noexcept;
  bool acceptable(const BodyOptions& with) const noexcept;
  BodyId id_of(BodyIndex index) const noexcept { return places.body(index).id; }
  bool contains(BodyId body) const noexcept {
    if (failed) return false;
    return detail::is_half_space(body.index) ? halves.contains(body) : bodies.contains(body);
  }
  detail::Body* find(BodyId body) noexcept;
  void update_again(detail::Body& body);  // its promise holds no longer
  void go_by_origins();
  void changed(detail::Body& body) noexcept { body.moved = answered + 1; }
  Motion place_of(const detail::Body& body) const noexcept;  // of a static one
  static BodyFilter broad_filter(const detail::Body& body) noexcept;
  void stir(detail::Body& body) noexcept;  // what sleeps

  // kept_states.cpp: bodies whose states the detector keeps
  double last_time() const noexcept;  // that of the last step, or of the first one
  void keep(const detail::Body& body, BodyState state);

  // sample_states.cpp: what the broad phase is told, and whether it holds
  Motion promise_of(BodyIndex body, double time) const;  // what is relied on
  void motions(double time, std::span<const BodyIndex> asked, std::span<Motion> motions);
  void watch(Step step);
  void ask_all(Step step);
  bool keeps_more(const detail::Body& body, Step step, const Motion& motion) const noexcept;
  void note_refused(std::span<const BodyIndex> more);

  // detector_step.cpp: a step from its beginning to its end
  void run(double time, const Budget& budget, const StepOptions& with, Frame& frame);
  void run_to(Step last, Step end, detail::StepBudget& budget, Frame& frame);
  void leave_out_before(Step end, Frame& frame);
  bool full() const noexcept { return event_count >= options.max_events; }
  bool still_there(const detail::RecordTable::Known& known) const noexcept;
  void gather(Step step, const Advance& now);
  void ask_involved(Step step);
  void answer(Step step, const Advance& now, detail::StepBudget& budget, Frame& frame);
  void answer_within(Step step, const detail::StepBudget::Stopwatch& watch, detail::StepBudget& budget, Frame& frame);

  // search_by_parts.cpp: pairs with static bodies that are found by the parts of a body
  bool found_by_parts(const BodyPair& pair) const noexcept;
  void keep_part_pairs(BodyIndex body);
  void find_part_pairs(Step step);
  void search_by_parts(BodyIndex body, bool wanted);
  void choose_part_searches(Step step);

  // skip_pairs.cpp: which pairs need no answer at this step
  detail::Standing standing(const BodyPair& pair) const noexcept;
  bool clear(const detail::RecordTable::Known& known) const noexcept;
  bool sphere_above(const BodyPair& pair) const noexcept;
  template <bool kParts>
  std::size_t find_near_spheres(std::size_t begin, std::size_t end, std::uint32_t* near) const noexcept;
  std::size_t find_near(std::size_t begin, std::size_t end, std::uint32_t* near) noexcept;
  void find_active();

  // match_pairs.cpp: the pairs beside those of the step before
  void match(Step step, Frame& frame);
  detail::Record& record_of(detail::RecordTable::Known& known) noexcept;
  bool parts(const detail::RecordTable::Known& known, Step step);
  bool allowed(detail::Record& record);

  // report_events.cpp: pairs are opened, concluded, and reported
  enum class Outcome : std::uint8_t {  // the events, and none
    begin = static_cast<std::uint8_t>(PairChange::begin),
    stay = static_cast<std::uint8_t>(PairChange::stay),
    end = static_cast<std::uint8_t>(PairChange::end),
    possible = static_cast<std::uint8_t>(PairChange::possible),
    nothing
  };
  struct Tally {                                     // of a job's records, and where their events are to be
    std::size_t events = 0, certain = 0, large = 0;  // large: begun now
    double worst_bound = 0;
    std::size_t ended_from = 0, events_from = 0;
  };
  void open_records(Step step);
  bool opens(detail::Record& record, Step step, bool& over) noexcept;
  void ask_filter();
  bool reusable(const detail::Record& record) const noexcept;
  std::uint64_t answer_one_by_one(Step step);
  Outcome begin_or_end(detail::Record& record) const noexcept;
  void conclude(std::size_t i, detail::Record& record, Tally& tally) noexcept;
  void keep_clearance(detail::RecordTable::Known& known, const detail::Record& record) const noexcept;
  ORCHARD_INLINE void prefetch_active(std::size_t i, std::size_t end) const noexcept;
  std::size_t first_of_job(std::size_t job) const noexcept { return active_count * job / job_count; }
  void tally(std::size_t job, Tally& tally) noexcept;
  void tally_all();
  void describe(const detail::Record& record, Step step, PairChange change, PairEvent& event) const noexcept;
  void write_events(std::size_t job, Step step, std::size_t ended_to) noexcept;
  void report(Step step, Frame& frame);

  // manifold.cpp
  Manifold manifold(const PairEvent& event, const ContactOptions& with) noexcept;

  DetectorOptions options;
  bool watches;
  bool stepping = false;  // step() is under way, from within which the application's functions are called
  bool valid;
  detail::Clock clock;
  detail::ShapeTable shapes;
  std::size_t shape_count = 0;
  std::unique_ptr<detail::KeptStates> kept_states;  // null: the application has them
  detail::BodyTable bodies;
  detail::HalfSpaces halves;
  detail::Places places;
  BroadPhase broad;
  MotionMonitor monitor;
  PairFilter filter;
  std::uint32_t filter_version = 0;
  detail::RecordTable records;
  detail::QueryPool queries;
  detail::FrontPool fronts;
  std::size_t large_pairs = 0;  // among the records
  detail::Rounds rounds;
  detail::PartSearch part_search;

  Step answered = -1;      // up to which steps have been answered
  bool all_asked = false;  // everybody's state is that of the step that the broad phase is at
  Step all_asked_at = detail::kNotAsked;
  Step involved_at = detail::kNotAsked;  // the step of `involved`
  Step choose_parts_at = 0;              // who is searched by parts
  std::size_t count = 0;
  bool failed = false;          // out of memory
  bool any_continuous = false;  // bodies, ever
  bool any_static = false;      // bodies, ever
  bool filters_pairs = false;   // any body, ever: by its filter
  bool any_jumped = false;      // bodies, since the last step that was answered
  bool interrupted = false;     // the broad phase, at the step before
  detail::LoadModel load_model;
  detail::LoadModel::Pairs pairs_seen;  // of the step under way

  // Of the step under way; kept for their memory.
  std::vector<BodyIndex> due, involved, everyone, refused, broken;
  std::vector<Motion> due_motions;
  std::vector<std::uint8_t> is_involved;    // by body, while `involved` is made
  std::vector<std::uint32_t> static_pairs;  // by body, in choose_part_searches()
  std::vector<BodyIndex> searches_to_change;
  detail::StepPairs pairs;
  std::vector<std::uint32_t> active;  // places in `records` that have to be looked at: active_count of them
  std::vector<std::size_t> active_of_job;
  std::size_t active_count = 0;
  std::vector<std::uint32_t> open;  // records to be asked about
  std::vector<std::uint8_t> marks;  // of `active`
  std::vector<Tally> tallies;       // job_count of them
  std::size_t job_count = 1;
  std::vector<PairEvent> events;  // event_count of them
  std::size_t event_count = 0;
  std::vector<PairEvent> ended;  // in match() and open_records(), until report() merges them in
};

}  // namespace orchard::runtime
