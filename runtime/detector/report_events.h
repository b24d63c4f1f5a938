#pragma once
#include "detector/skip_pairs.h"

namespace orchard::runtime::detail {

// Report: from answers to events.
class EventReporter {
 public:
  EventReporter(const World& world, const PairSkipper& skipper) noexcept : world_(world), skipper_(skipper) {}

  void begin_call() noexcept { events_.clear(), ended_.clear(); }
  bool full() const noexcept { return events_.size() >= world_.options.max_events; }

  // A pair that is none any more. True: it is still reported as touching, as long as steps_to_end says.
  bool part(CachedPair& pair, bool there, bool jumped, Step step);
  void end_by_teleport(CachedPair& pair, Step step);
  void begin_step(const ActivePairs& active) { grow(outcomes_, active.size()); }
  // What the answer of an active pair, or that none was asked for, makes of it. Jobs may do so at once.
  void conclude(const ActivePairs& active, std::size_t i) noexcept;
  // Appends the events of the step, in ascending order of pairs; what has ended of a pair comes before what has begun.
  void report(const ActivePairs& active, Step step, Frame& frame);

  std::span<const PairEvent> events() const noexcept { return events_; }
  std::size_t memory_bytes() const noexcept { return bytes_of(outcomes_, events_, ended_); }

 private:
  using Outcome = std::optional<PairChange>;
  Outcome begin_or_end(CachedPair& pair) const noexcept;
  PairEvent describe(const CachedPair& pair, Step step, PairChange change) const noexcept;

  const World& world_;
  const PairSkipper& skipper_;
  std::vector<Outcome> outcomes_;  // of the active pairs
  std::vector<PairEvent> events_;  // of this call
  std::vector<PairEvent> ended_;   // before any answer, until report() merges them in
};

}  // namespace orchard::runtime::detail
