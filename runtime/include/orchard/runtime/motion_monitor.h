#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/runtime/broad_phase.h"

// Checks whether bodies keep the bounds on their motion, and suggests bounds.
namespace orchard::runtime {

// The options of a MotionMonitor.
struct MonitorOptions {
  // A suggested M is the largest acceleration of the last `window` seconds times this factor, at least 1. Higher values
  // give looser bounds, which bodies exceed less often.
  double safety = 1.5;
  double window = 0.5;  // The length of the observed past, in seconds, above 0.
  // The range, in seconds, of the time until suggested bounds expire.
  double min_horizon = 0.02, longest_horizon = 1;
  double min_acceleration = 0;  // The smallest suggested M.
  double position_slack = 0;    // The error of positions, as in BroadPhaseOptions.
};

// Observes the motions of bodies (dissertation 4.4): whether they keep their bounds, and which bounds they would keep.
// A broad phase misses a contact only if a body exceeds its bounds and nothing cancels them.
// (BroadPhaseOptions::validate finds such bounds while a program is developed.) Use the monitor where the simulation
// moves its bodies:
//   monitor.note_bound(body, time, motion);                                     // in the source, for what it returns
//   if (!monitor.observe(body, time, position, velocity)) world.cancel(id);   // at every step, before advance()
// A Detector with DetectorOptions::watch does this itself. The monitor allocates only when a body index occurs for the
// first time. O(1) per call.
class MotionMonitor {
 public:
  explicit MotionMonitor(const MonitorOptions& options = {}) : options_(options) {}

  // Replaces the bounds of a body by those of `motion`, given at `time`.
  void note_bound(BodyIndex body, double time, const Motion& motion);

  // Records the position and the velocity of a body at `time`. Returns false if the body exceeds its last bounds: if
  // Lemma 4.1 or 4.2 does not hold, or if the velocity has left its bound. The violation is counted once, and the
  // bounds are cancelled. Returns true if the body has no bounds or they have expired. Times must not decrease;
  // repeating a time does not change what the monitor has learnt.
  bool observe(BodyIndex body, double time, const Vec3& position, const Vec3& velocity);
  // Does the same without a velocity: compares positions only, and uses the difference of the last two positions as the
  // velocity for suggestions.
  bool observe(BodyIndex body, double time, const Vec3& position);

  // Returns a motion with suggested bounds, after observe() at `time`. M is `safety` times the largest acceleration of
  // the last `window` seconds. half_space is opposite to the mean acceleration if every recent acceleration was
  // certainly within 60 degrees of it. The time until expiry is halved after each violation and grows by a quarter
  // after each time without one, within the range of the options. The radius is the given one. The suggestion is a
  // guess about the future; observe() finds out if it was wrong.
  Motion suggest(BodyIndex body, double time, double radius) const;

  void cancelled(BodyIndex body);     // The application cancelled the bounds.
  void forget(BodyIndex body);        // A teleport: discards everything known, but keeps the counts.
  void begin(BodyIndex body);         // Another body has this index: discards everything known and its counts.
  void count_broken(BodyIndex body);  // Counts a violation of another bound, and cancels the present bounds.
  std::uint64_t broken() const noexcept { return broken_; }
  std::uint64_t broken(BodyIndex body) const noexcept { return body < tracks_.size() ? tracks_[body].broken : 0; }
  std::size_t memory_bytes() const noexcept { return tracks_.capacity() * sizeof(Track); }

 private:
  static constexpr std::size_t kParts = 4;  // the number of parts of the window
  struct Part {                             // a part of the window: the accelerations that were seen in it
    double begin = 0;
    double largest = 0;
    Vec3 sum{};
    std::uint32_t count = 0;
    Vec3 lower{1, 1, 1}, upper{-1, -1, -1};  // a box around their directions
    void add(const Vec3& acceleration) noexcept;
    double min_along(const Vec3& way) const noexcept;  // a lower bound on the cosines of their angles with `way`
  };
  struct Track {
    // The bounds.
    bool bounded = false;
    double bound_time = 0;
    Motion motion;
    // What was seen last.
    std::uint32_t seen = 0;  // observations, at most 3
    bool velocity_given = false;
    double time = 0, step = 0;
    Vec3 position{}, velocity{};
    std::array<Part, kParts> parts{};
    std::uint32_t part = 0;
    double horizon = 0, kept_since = 0;
    std::uint64_t broken = 0;
  };

  Track& track(BodyIndex body);
  bool observe(BodyIndex body, double time, const Vec3& position, const Vec3* velocity);
  void learn(Track& track, double time, const Vec3& position, const Vec3* velocity) const noexcept;

  MonitorOptions options_;
  std::vector<Track> tracks_;  // by body
  std::uint64_t broken_ = 0;
};

}  // namespace orchard::runtime
