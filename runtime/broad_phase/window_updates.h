#pragma once
#include <memory>

#include "broad_phase/near_pairs.h"

namespace orchard::runtime::detail {

// Window updates make boxes from motions, and near pairs from boxes that meet. Bodies are updated in chunks. For a
// chunk, first the boxes are made, with a list of the lines of the grid that they go to (visits); then they are
// inserted there, which finds the pairs.
//
// If all windows of many bodies are updated, jobs do it that may run at the same time. Bodies are processed in waves,
// each in two passes. In the first pass, each job makes the boxes of a chunk. In the second one, each job inserts the
// boxes of all chunks into one part of the lines, and tests the near pairs that it finds. The division depends only on
// the number of bodies, and results are put together in the order of the chunks or of the parts. So nothing depends on
// the executor. Even one thread is faster this way, if a part of the lines fits into its cache and all of them do not.
class WindowUpdates {
 public:
  WindowUpdates(KineticState& state, NearPairs& pairs);
  ~WindowUpdates();

  // Updates the windows of bodies with their motions at `now`, and tests the near pairs. The windows begin at the step
  // `from`. If that is later than `now`, bodies whose bounds do not reach it are noted as changed, so that the later
  // step updates them.
  void update(Step now, Step from, std::span<const BodyIndex> bodies);
  // Does the same for all bodies of the world. If they are many, the executor's jobs do it.
  void update_all(Step now, Step from, std::span<const BodyIndex> bodies);
  // Does the same as update() with from = now, but returns the near pairs without testing them.
  std::span<const BodyPair> find_near(Step now, std::span<const BodyIndex> bodies);
  // Returns whether the motions at `now` of at least half of the bodies hold up to `from`. It is for a few bodies,
  // whose order it changes.
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
  std::vector<BodyPair> near_;      // near pairs that are not tested yet
  std::unique_ptr<Chunk> chunk_;    // of the calling thread
  std::unique_ptr<Shared> shared_;  // of the jobs; null until there are many bodies
};

// At most kBlock bodies, whose boxes are made together.
struct WindowUpdates::Block {
  Step now;                                                  // the step of the motions
  Step from;                                                 // the step at which the windows begin
  QuantizedGrid quantized_grid;                              // at `now`
  std::array<Step, kBlock> ends;                             // the ends of the windows
  std::array<double, kBlock> durations;                      // the seconds from `now` to the last step before the end
  double expiry = std::numeric_limits<double>::quiet_NaN();  // the one that all of `ends` and `durations` are for
  BoxBlock boxes;
  bool by_part = false;  // whether visits are split by the grid's parts, for several threads
};

// The bodies that one job, or one call, has processed.
struct WindowUpdates::Chunk {
  struct Left {
    BodyIndex body;
    Motion motion;
  };
  SweptGrid::VisitsByPart visits;  // by part of the grid, or all in the first one
  SweptGrid::Visits block_visits;  // of the block under way
  std::vector<BodyIndex> placed;   // bodies whose boxes are made, in order
  std::vector<BodyIndex> unknown;  // bodies whose bounds do not reach Block::from
  std::vector<Left> left;          // bodies with invalid motions or too large boxes; they are processed one by one
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
