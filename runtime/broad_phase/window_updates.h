#pragma once
#include <memory>

#include "broad_phase/near_pairs.h"
#include "broad_phase/planner.h"

namespace orchard::runtime::detail {

// Window updates: motions become boxes, boxes that meet become near pairs.
class WindowUpdates {
 public:
  // The parts that an update changes; they outlive this.
  struct Parts {
    BodyPool& pool;
    Changes& changes;
    Windows& windows;
    BoxIndex& boxes;
    TimingWheel& wheel;
    OverlapList& overlaps;
    InvalidBodies& refusals;
    Planner& planner;
    NearPairs& pairs;
  };
  WindowUpdates(const Parts& parts, const BroadPhaseOptions& options);
  ~WindowUpdates();

  // The bodies' windows begin at `from`, from the motions at `now`. Where it is a later step, bodies whose bounds do
  // not reach it are left to it as changed ones. What is near is tested.
  void update(Step now, Step from, std::span<const BodyIndex> bodies);
  // The same where all windows start over: many bodies by the executor's jobs.
  void update_all(Step now, Step from, std::span<const BodyIndex> bodies);
  // The same as update(), untested: what is near.
  std::span<const BodyPair> find_near(Step now, std::span<const BodyIndex> bodies);
  // Whether at least half of the bodies know at `now` what holds at `from`.
  bool know_mostly(Step now, Step from, std::span<BodyIndex> bodies);
  // Asks for the motions of at most kBlock bodies, and moves those whose motions are valid to the front.
  std::span<const Motion> ask_valid(Step now, std::span<BodyIndex>& bodies);

  std::size_t memory_bytes() const noexcept;

 private:
  struct Block;
  void make_room_for_motions(std::size_t count) {
    if (motions_.size() < count) motions_.resize(count);
  }
  void find(Step now, Step from, std::span<const BodyIndex> bodies, bool tested);
  void test_near(Step now);
  std::size_t known_at(Step from, std::span<BodyIndex> bodies, std::span<Motion> motions) const noexcept;
  std::size_t refuse_invalid(std::span<BodyIndex> bodies);
  bool place(Block& block, std::span<const BodyIndex> bodies);
  bool set_ends(Block& block, std::span<const BodyIndex> bodies, std::span<const Motion> motions) const noexcept;
  bool make_boxes(Block& block, std::span<const Motion> motions, bool same_ends) const noexcept;
  bool note_boxes(Block& block, std::span<const BodyIndex> bodies);
  void shrink(Block& block, BodyIndex body, std::size_t i);
  void drop_what_is_none();

  // Many at once (window_updates_shared.cpp).
  struct Chunk;
  struct GridPart;
  struct Shared;
  void place_chunk(Chunk& chunk, Block& block, std::span<const BodyIndex> bodies) const;
  void place_shared(Chunk& chunk, Block& block, std::span<BodyIndex> bodies, std::span<Motion> motions) const;
  void fold(Chunk& chunk);
  void find_in_part(Step now, std::size_t index);
  bool are_many(std::size_t bodies) const noexcept;
  void update_wave(Step now, Step from, std::span<const BodyIndex> bodies);
  template <typename Job>
  void run_all(std::size_t count, const Job& job);

  const Parts parts_;
  const BroadPhaseOptions& options_;
  std::vector<Motion> motions_;     // of the block under way
  std::vector<BodyPair> near_;      // untested yet
  std::unique_ptr<Shared> shared_;  // null until there are many
};

struct WindowUpdates::Block {
  Step now;                              // the motions are of this step,
  Step from;                             // and count from this one
  QuantizedGrid quantized_grid;          // at `now`
  Step common = kUpdateDue;              // what all ends are, and durations until then; kUpdateDue: they are not
  std::array<Step, kBlock> ends;         // of the bodies' windows
  std::array<double, kBlock> durations;  // until then, of which the last step is not
  BoxBlock boxes;
  Windows::LastEnd last;
};

}  // namespace orchard::runtime::detail
