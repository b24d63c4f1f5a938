#pragma once
#include "near_pairs.h"
#include "planner.h"

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
    Refusals& refusals;
    Planner& planner;
    NearPairs& pairs;
  };
  WindowUpdates(const Parts& parts, const BroadPhaseOptions& options) : parts_(parts), options_(options) {}

  // The bodies' windows begin at `from`, from the motions at `now`. Where it is a later step, bodies whose bounds do
  // not reach it are left to it as changed ones. What is near is tested.
  void update(Step now, Step from, std::span<const BodyIndex> bodies);
  // The same, untested: what is near.
  std::span<const BodyPair> find_near(Step now, std::span<const BodyIndex> bodies);
  // Whether at least half of the bodies know at `now` what holds at `from`.
  bool know_mostly(Step now, Step from, std::span<BodyIndex> bodies);
  // Asks for the motions of at most kBlock bodies, and moves those whose motions are valid to the front.
  std::span<const Motion> ask_valid(Step now, std::span<BodyIndex>& bodies);

  std::size_t memory_bytes() const noexcept { return bytes_of(motions_) + bytes_of(near_); }

 private:
  struct Block;
  void find(Step now, Step from, std::span<const BodyIndex> bodies, bool tested);
  void test_near(Step now);
  std::size_t known_at(Step from, std::span<BodyIndex> bodies) noexcept;
  std::size_t refuse_invalid(std::span<BodyIndex> bodies);
  bool place(Block& block, std::span<const BodyIndex> bodies);
  bool set_ends(Block& block, std::span<const BodyIndex> bodies);
  bool note_boxes(Block& block, std::span<const BodyIndex> bodies);
  void shrink(Block& block, BodyIndex body, std::size_t i);
  void drop_what_is_none();

  const Parts parts_;
  const BroadPhaseOptions& options_;
  std::vector<Motion> motions_;  // of the block under way
  std::vector<BodyPair> near_;   // untested yet
};

}  // namespace orchard::runtime::detail
