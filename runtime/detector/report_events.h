#pragma once
#include "detector/skip_pairs.h"

namespace orchard::runtime::detail {

// The stage "report" of a step: derives events from the answers.
class EventReporter {
 public:
  EventReporter(const World& world, const PairSkipper& skipper) noexcept : world_(world), skipper_(skipper) {}

  void begin_call() noexcept { events_.clear(), ended_.clear(); }
  bool full() const noexcept { return events_.size() >= world_.options.max_events; }

  // Reports on a pair that is none any more. Returns true if it still counts as touching, because
  // DetectorOptions::steps_to_end is not reached. `there`: both bodies exist and filters allow the pair. `jumped`: one
  // was teleported.
  bool part(CachedPair& pair, bool there, bool jumped, Step step);
  // Ends the touch of a pair one of whose bodies was teleported.
  void end_by_teleport(CachedPair& pair, Step step);
  void begin_step(const ActivePairs& active) { grow(outcomes_, active.size()); }
  // Updates the record of an active pair, whether it was answered at this step or not, and notes which event follows.
  // Jobs may call it at the same time for different pairs.
  void conclude(const ActivePairs& active, std::size_t i) noexcept;
  // Appends the events of the step, in ascending order of pairs. If a pair has two events, the end comes before the
  // beginning.
  void report(const ActivePairs& active, Step step, Frame& frame);

  std::span<const PairEvent> events() const noexcept { return events_; }
  std::size_t memory_bytes() const noexcept { return bytes_of(outcomes_, events_, ended_); }

 private:
  using Outcome = std::optional<PairChange>;
  Outcome begin_or_end(CachedPair& pair) const noexcept;
  PairEvent describe(const CachedPair& pair, Step step, PairChange change) const noexcept;

  const World& world_;
  const PairSkipper& skipper_;
  std::vector<Outcome> outcomes_;  // by active pair
  std::vector<PairEvent> events_;  // of this call of step()
  std::vector<PairEvent> ended_;   // of pairs that ended before any answer, until report() merges them with the others
};

}  // namespace orchard::runtime::detail
