#pragma once
#include "broad_phase/box_index.h"
#include "broad_phase/changes.h"
#include "broad_phase/overlap_list.h"
#include "broad_phase/pair_times.h"
#include "broad_phase/windows.h"

namespace orchard::runtime::detail {

// What becomes of a body whose motion is not valid: it is in no pair until it has been asked again.
class InvalidBodies {
 public:
  InvalidBodies(BodyPool& pool, Windows& windows, BoxIndex& boxes, OverlapList& overlaps, Changes& changes)
      : pool_(pool), windows_(windows), boxes_(boxes), overlaps_(overlaps), changes_(changes) {}
  void refuse(BodyIndex body);

 private:
  BodyPool& pool_;
  Windows& windows_;
  BoxIndex& boxes_;
  OverlapList& overlaps_;
  Changes& changes_;
};

// Tests pairs that are near: they overlap, for a while or for sure up to a step, or get an event at the first step at
// which they can.
class NearPairs {
 public:
  static constexpr std::size_t kTestsAtOnce = kPairsAtOnce;

  NearPairs(BodyPool& pool, const BroadPhaseOptions& options, Windows& windows, TimingWheel& wheel,
            OverlapList& overlaps, InvalidBodies& refusals)
      : pool_(pool), options_(options), windows_(windows), wheel_(wheel), overlaps_(overlaps), refusals_(refusals) {}

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
    std::uint64_t asked = 0, compared = 0, settled = 0;
    std::vector<PairEvent> tests;  // and what the tests work with
    std::vector<Motion> motions;
    BodyPool::Answers answers;
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

  // What a window update takes note of where many pairs are near: most of them need no other test. Where that was not
  // so the last time it is tried again some updates of all windows later.
  void note_spheres(bool wanted, std::size_t slots);
  void release_spheres() noexcept;  // and their memory
  void make_room_for_spheres(std::size_t slots) {
    if (!spheres_.empty()) grow(spheres_, slots);
  }
  void note_sphere(BodyIndex body, const Motion& motion, const QuantizedGrid& quantized_grid, double duration) noexcept;
  bool notes_spheres() const noexcept { return !spheres_.empty(); }

  void forget_all() noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  struct Sphere {                 // in a third of the memory of a motion's part, and off by its rounding
    std::array<float, 3> center;  // from the quantized grid's origin
    float radius, reach;          // reach: as far as the centre may get until the body's window ends, and all slack
  };
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

  BodyPool& pool_;
  const BroadPhaseOptions& options_;
  Windows& windows_;
  TimingWheel& wheel_;
  OverlapList& overlaps_;
  InvalidBodies& refusals_;
  bool ahead_ = false, within_budget_ = false;
  std::vector<Sphere> spheres_;               // by body; empty unless many pairs are near
  std::uint64_t compared_ = 0, settled_ = 0;  // pairs, by spheres, since spheres_ began
  unsigned in_vain_ = 0;                      // updates of all windows that take no note of spheres, to come
  std::vector<BodyPair> overlaps_ahead_;      // of pairs tested ahead for the next step, at which they surely touch,
  Round ahead_round_ = 0;                     // in this round
  std::vector<PairEvent> doubtful_;  // reported within a budget, before another update that may not have found them yet
  Outcome own_;                      // of what no job tests; kept for its memory
  std::vector<BodyPair> sure_;
};

}  // namespace orchard::runtime::detail
