#pragma once
#include "broad_phase/kinetic_state.h"
#include "broad_phase/sphere_notes.h"

namespace orchard::runtime::detail {

// Tests near pairs. A pair that overlaps goes into the list of overlaps, with an event at the first step at which it
// can have parted. Any other pair gets an event at the first step at which it can overlap.
class NearPairs {
 public:
  static constexpr std::size_t kTestsAtOnce = kPairsAtOnce;

  explicit NearPairs(KineticState& state) : state_(state), spheres_(state.options.position_slack) {}

  // Within a budget, an overlap is doubtful if one of its bodies is updated again before the step ends.
  void begin_step(bool within_budget);
  // `ahead`: further tests are for the next step, from the motions of this one.
  void work_ahead(bool ahead) noexcept { ahead_ = ahead; }
  // Tests pairs whose events are due, and may change the order of `events`.
  void test(Step now, std::span<PairEvent> events);
  // Tests pairs that the window updates of this round have found and that the filters allow.
  void test_near(Step now, std::span<const BodyPair> pairs);
  // The results of tests. They have no effect before take(), so that each of the jobs that run at the same time can
  // have an outcome of its own.
  struct Outcome {
    struct Later {  // made where it stays: copies of small parts would wait for their writes
      Later(const BodyPair& pair, Round round, bool parting, Step at) noexcept
          : event(pair, round, parting), step(at) {}
      PairEvent event;
      Step step;
    };
    std::vector<BodyPair> touching, parted, ahead;
    std::vector<Later> later;
    std::vector<PairEvent> doubtful;
    std::vector<BodyIndex> refused;
    std::uint64_t asked = 0;
    std::vector<PairEvent> tests;  // this and the members below are scratch
    std::vector<Motion> motions;
    MotionQueries::Answers answers;
    std::size_t memory_bytes() const noexcept {
      return bytes_of(touching, parted, ahead, later, doubtful, refused, tests, motions) + answers.memory_bytes();
    }
  };
  void test_near(Step now, std::span<const BodyPair> pairs, Outcome& outcome) const;
  void take(Outcome& outcome);  // applies the outcome to the state, and empties it
  // Adds the pairs that were found ahead for this step to the overlaps, unless a body has been updated since.
  void take_overlaps_ahead();
  // Appends them to the events to test instead.
  void take_overlaps_ahead(std::vector<PairEvent>& events);
  // Ends a step within a budget. Overlaps that are still doubtful are dropped at the next step, unless they are found
  // again.
  void keep_doubtful();

  SphereNotes& spheres() noexcept { return spheres_; }  // window updates add the spheres of bodies

  void forget_all() noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  bool settle_by_spheres(Step now, const BodyPair& pair, Outcome& outcome) const;
  struct Horizon {    // how many steps a test can look ahead
    Step left, safe;  // the steps until the next update of one of the bodies, and those for which both bounds hold
    Step whole;       // the steps before `left` for which both bounds hold; at least 0
  };
  void find_horizon(Step now, const BodyPair& pair, const Motion& a, const Motion& b, Horizon& horizon) const noexcept;
  static std::size_t refuse_invalid(std::span<PairEvent> events, std::span<Motion> motions, Outcome& outcome);
  void test(Step now, std::span<PairEvent> events, Outcome& outcome) const;
  void settle_all(Step now, std::span<PairEvent> events, Outcome& outcome) const;
  void settle(Step now, const PairEvent& event, const Horizon& horizon, double limit, bool touching, double seconds,
              Outcome& outcome) const;
  void settle_touching(Step now, const PairEvent& event, Step left, Step sure, Outcome& outcome) const;

  KineticState& state_;
  bool ahead_ = false, within_budget_ = false;
  SphereNotes spheres_;
  std::vector<BodyPair> overlaps_ahead_;  // pairs that were tested ahead and certainly touch at the next step
  Round ahead_round_ = 0;                 // the round of those tests
  std::vector<PairEvent> doubtful_;       // overlaps within a budget; a later update may not have found them again yet
  Outcome own_;                           // of the tests that are not jobs; a member to reuse its memory
  std::vector<BodyPair> sure_;
};

}  // namespace orchard::runtime::detail
