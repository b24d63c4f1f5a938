#pragma once
#include <memory>

#include "broad_phase/near_pairs.h"

namespace orchard::runtime::detail {

// Window updates: motions become boxes, boxes that meet become near pairs. Bodies come in chunks. Of a chunk first the
// boxes are made, and it is noted which lines of the grid they go to; then they are put there, which finds the pairs.
//
// Updates of all windows of many bodies are jobs that may run at once. Of a wave of bodies each job first places a
// chunk; then each puts the boxes of all chunks into one part of the lines, and tests what it finds near. How that is
// cut depends on the number of bodies alone, and everything that has an order is put together in that of the chunks, or
// of the parts: so nothing depends on the executor. One thread gains by it, too, where all lines do not fit into its
// cache and a part of them does.
class WindowUpdates {
 public:
  WindowUpdates(KineticState& state, NearPairs& pairs);
  ~WindowUpdates();

  // The bodies' windows begin at `from`, from the motions at `now`. Where it is a later step, bodies whose bounds do
  // not reach it are left to it as changed ones. What is near is tested.
  void update(Step now, Step from, std::span<const BodyIndex> bodies);
  // The same where all windows start over: many bodies by the executor's jobs.
  void update_all(Step now, Step from, std::span<const BodyIndex> bodies);
  // The same as update(), untested: what is near.
  std::span<const BodyPair> find_near(Step now, std::span<const BodyIndex> bodies);
  // Whether at least half of the bodies, which are few, know at `now` what holds at `from`.
  bool know_mostly(Step now, Step from, std::span<BodyIndex> bodies);
  // Asks for the motions of at most kBlock bodies, and moves those whose motions are valid to the front.
  std::span<const Motion> ask_valid(Step now, std::span<BodyIndex>& bodies);

  std::size_t memory_bytes() const noexcept;

 private:
  struct Block;
  struct Chunk;
  struct GridPart;
  struct Shared;
  std::span<Motion> ask(Step now, std::span<const BodyIndex> bodies);
  std::size_t known_at(Step from, std::span<BodyIndex> bodies, std::span<Motion> motions) const noexcept;
  bool set_ends(Block& block, std::span<const BodyIndex> bodies, std::span<const Motion> motions) const noexcept;
  bool make_boxes(Block& block, std::span<const BodyIndex> bodies, std::span<const Motion> motions) const noexcept;
  Block block_at(Step now, Step from) const noexcept;
  void place(Chunk& chunk, Block& block, std::span<BodyIndex> bodies, std::span<Motion> motions) const;
  void place_chunk(Chunk& chunk, Block& block, std::span<const BodyIndex> bodies) const;
  void fold(Chunk& chunk);
  void place_left(Chunk& chunk, Block& block);
  QuantizedAabb shrink(Block& block, Window& window, const Motion& motion) const noexcept;
  void find(Step now, Step from, std::span<const BodyIndex> bodies, bool tested);
  void test_near(Step now);
  void drop_what_is_none();
  void find_in_part(Step now, std::size_t index);
  void update_wave(Step now, Step from, std::span<const BodyIndex> bodies);
  template <typename Job>
  void run_all(std::size_t count, const Job& job);

  KineticState& state_;
  NearPairs& pairs_;
  std::vector<Motion> motions_;     // of the block under way
  std::vector<BodyPair> near_;      // untested yet
  std::unique_ptr<Chunk> chunk_;    // of the calling thread
  std::unique_ptr<Shared> shared_;  // null until there are many
};

struct WindowUpdates::Block {
  Step now;                              // the motions are of this step,
  Step from;                             // and count from this one
  QuantizedGrid quantized_grid;          // at `now`
  std::array<Step, kBlock> ends;         // of the bodies' windows
  std::array<double, kBlock> durations;  // until then, of which the last step is not
  BoxBlock boxes;
  bool by_part = false;  // whether visits are split by the grid's parts, for several threads
};

struct WindowUpdates::Chunk {
  struct Left {
    BodyIndex body;
    Motion motion;
  };
  SweptGrid::VisitsByPart visits;  // to each part, or all in the first one
  SweptGrid::Visits block_visits;  // of the block under way
  std::vector<BodyIndex> placed;   // in order
  std::vector<BodyIndex> unknown;  // what holds from the later step on
  std::vector<Left> left;          // not valid, or too large: placed one by one
  std::vector<Motion> motions;     // of the block under way
  QuantizedAabb extent;
  MotionQueries::Answers answers;
  std::uint64_t asked;

  void clear() noexcept {
    for (auto& part : visits) part.clear();
    placed.clear(), unknown.clear(), left.clear();
    extent = kNoBox;
    asked = 0;
  }
  std::size_t memory_bytes() const noexcept {
    std::size_t bytes = bytes_of(placed, unknown, left, motions) + answers.memory_bytes() + block_visits.memory_bytes();
    for (const auto& part : visits) bytes += part.memory_bytes();
    return bytes;
  }
};

}  // namespace orchard::runtime::detail
