#pragma once
#include "broad_phase/kinetic_state.h"
#include "broad_phase/sphere_notes.h"

namespace orchard::runtime::detail {

// Tests pairs that are near: they overlap, for a while or for sure up to a step, or get an event at the first step at
// which they can.
class NearPairs {
 public:
  static constexpr std::size_t kTestsAtOnce = kPairsAtOnce;

  explicit NearPairs(KineticState& state) : state_(state), spheres_(state.options.position_slack) {}

  // ahead: for the next step, from the motions of this one. within_budget: what overlaps may be doubted.
  void begin_step(bool within_budget);
  void work_ahead(bool ahead) noexcept { ahead_ = ahead; }
  void test(Step now, std::span<PairEvent> events);  // which may change their order
  // Pairs that window updates of this round have found, and the filters have let pass.
  void test_near(Step now, std::span<const BodyPair> pairs);
  // What becomes of pairs that are tested. It counts once it has been taken over, so that jobs that run at once may
  // have one each.
  struct Outcome {
    struct Later {
      PairEvent event;
      Step step;
    };
    std::vector<BodyPair> touching, parted, ahead;
    std::vector<Later> later;
    std::vector<PairEvent> doubtful;
    std::vector<BodyIndex> refused;
    std::uint64_t asked = 0;
    std::vector<PairEvent> tests;  // and what the tests work with
    std::vector<Motion> motions;
    MotionQueries::Answers answers;
    std::size_t memory_bytes() const noexcept {
      return bytes_of(touching, parted, ahead, later, doubtful, refused, tests, motions) + answers.memory_bytes();
    }
  };
  void test_near(Step now, std::span<const BodyPair> pairs, Outcome& outcome) const;
  void take(Outcome& outcome);
  // What was found to overlap a step ahead: it does, unless a body has been updated since.
  void take_overlaps_ahead();
  void take_overlaps_ahead(std::vector<PairEvent>& events);
  void keep_doubtful();  // at the end of a step within a budget

  SphereNotes& spheres() noexcept { return spheres_; }  // what a window update takes note of

  void forget_all() noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  bool settle_by_spheres(Step now, const BodyPair& pair, Outcome& outcome) const;
  struct Horizon {
    Step left, safe;  // steps until the next update of one of the bodies, and for which both bounds hold
    Step whole;       // up to which both are known
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
  std::vector<BodyPair> overlaps_ahead_;  // of pairs tested ahead for the next step, at which they surely touch,
  Round ahead_round_ = 0;                 // in this round
  std::vector<PairEvent> doubtful_;  // reported within a budget, before another update that may not have found them yet
  Outcome own_;                      // of what no job tests; kept for its memory
  std::vector<BodyPair> sure_;
};

}  // namespace orchard::runtime::detail
