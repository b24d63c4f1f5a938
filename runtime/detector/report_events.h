#pragma once
#include "detector/skip_pairs.h"

namespace orchard::runtime::detail {

// Report: from answers to events. By jobs, since most of it is waiting for memory.
class EventReporter {
 public:
  EventReporter(const World& world, const PairSkipper& skipper) noexcept : world_(world), skipper_(skipper) {}

  void begin_call() noexcept { event_count_ = 0, ended_.clear(); }
  bool full() const noexcept { return event_count_ >= world_.options.max_events; }

  // A pair that is none any more. True: it is still reported as touching, as long as steps_to_end says.
  bool part(CachedPair& pair, bool there, bool jumped, Step step);
  void end_by_teleport(CachedPair& pair, Step step);

  // What a job's share of the active pairs adds to the frame, and where their events are to be.
  struct Tally {
    std::size_t events = 0, certain = 0;
    double worst_bound = 0;
    std::size_t ended_from = 0, events_from = 0;
  };
  // Either conclude_all(), or these: so many jobs conclude all active pairs of theirs, in ascending order.
  void begin_jobs(const ActivePairs& active, std::size_t jobs);
  Tally& tally(std::size_t job) noexcept { return tallies_[job]; }
  std::size_t first_of_job(const ActivePairs& active, std::size_t job) const noexcept {
    return active.size() * job / job_count_;
  }
  void conclude(const ActivePairs& active, std::size_t i, Tally& tally) noexcept;
  void conclude_all(const ActivePairs& active);
  // Appends the events of the step, in ascending order of pairs; what has ended of a pair comes before what has begun.
  void report(const ActivePairs& active, Step step, Frame& frame);

  std::span<const PairEvent> events() const noexcept { return std::span(events_).first(event_count_); }
  std::size_t memory_bytes() const noexcept { return bytes_of(outcomes_, tallies_, events_, ended_); }

 private:
  enum class Outcome : std::uint8_t {  // the events, and none
    begin = static_cast<std::uint8_t>(PairChange::begin),
    stay = static_cast<std::uint8_t>(PairChange::stay),
    end = static_cast<std::uint8_t>(PairChange::end),
    possible = static_cast<std::uint8_t>(PairChange::possible),
    nothing
  };
  Outcome begin_or_end(CachedPair& pair) const noexcept;
  void describe(const CachedPair& pair, Step step, PairChange change, PairEvent& event) const noexcept;
  void place_events(const ActivePairs& active, Frame& frame);
  void write_events(const ActivePairs& active, std::size_t job, Step step) noexcept;

  const World& world_;
  const PairSkipper& skipper_;
  std::vector<Outcome> outcomes_;  // of the active pairs
  std::vector<Tally> tallies_;     // job_count_ of them
  std::size_t job_count_ = 1;
  std::vector<PairEvent> events_;  // event_count_ of them, of this call
  std::size_t event_count_ = 0;
  std::vector<PairEvent> ended_;  // before any answer, until report() merges them in
};

}  // namespace orchard::runtime::detail
