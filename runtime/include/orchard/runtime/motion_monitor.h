#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/runtime/broad_phase.h"

namespace orchard::runtime {

struct MonitorOptions {
  double safety = 1.5;  // a suggested M is the largest acceleration seen lately, times this; >= 1
  double window = 0.5;  // seconds: "lately". > 0
  double min_horizon = 0.02, longest_horizon = 1;  // seconds until a suggested promise expires
  double min_acceleration = 0;                     // no suggested M is smaller
  double position_slack = 0;                       // as BroadPhaseOptions has it: what positions may be off by
};

// Watches bodies' motions (dissertation 4.4): whether the bounds that were promised hold, and which ones could be
// promised, from what was seen. A promise that is broken silently is the one way in which a broad phase misses a
// contact. (BroadPhaseOptions::validate finds such ones while a program is being written.) Use it where the simulation
// moves its bodies:
//   monitor.note_bound(body, time, motion);                                     // in the source, as it answers
//   if (!monitor.observe(body, time, position, velocity)) world.cancel(id);   // at every step, before advance()
// A Detector with DetectorOptions::watch does so itself.
//
// Allocates only when a body index is seen for the first time. O(1) per call.
class MotionMonitor {
 public:
  explicit MotionMonitor(const MonitorOptions& options = {}) : options_(options) {}

  // The promise of `motion`, made at `time`, replaces the body's earlier one.
  void note_bound(BodyIndex body, double time, const Motion& motion);

  // Where the body is at `time`, and its velocity. False if Lemma 4.1 or 4.2 does not hold for the last promise, or the
  // velocity has left its bound: the promise is broken, counted once, and void from then on. True where nothing was
  // promised or the promise has expired. Times never decrease; the same time again changes nothing that is learnt.
  bool observe(BodyIndex body, double time, const Vec3& position, const Vec3& velocity);
  // The same without a velocity: only positions are compared, and the velocity for suggestions is the difference of the
  // last two positions.
  bool observe(BodyIndex body, double time, const Vec3& position);

  // A motion that can be promised now, after observe() at `time`: M is `safety` times the largest acceleration of the
  // last `window` seconds; half_space is opposite to the mean acceleration, if every acceleration seen lately was
  // surely within 60 degrees of it; expiry is a horizon that is halved by each broken promise and grows by a quarter
  // with each kept one, between the options' bounds. Radius as given. A guess about the future: observe() tells when it
  // was wrong.
  Motion suggest(BodyIndex body, double time, double radius) const;

  void cancelled(BodyIndex body);     // by the application: nothing is promised any more
  void forget(BodyIndex body);        // a teleport: nothing is known. Counts are kept
  void begin(BodyIndex body);         // another body with this index: nothing is known, and nothing counted of it
  void count_broken(BodyIndex body);  // a promise of another kind: the present one is void, too
  std::uint64_t broken() const noexcept { return broken_; }
  std::uint64_t broken(BodyIndex body) const noexcept { return body < tracks_.size() ? tracks_[body].broken : 0; }
  std::size_t memory_bytes() const noexcept { return tracks_.capacity() * sizeof(Track); }

 private:
  static constexpr std::size_t kParts = 4;  // of the window
  struct Part {                             // of the window: the accelerations seen in it
    double begin = 0;
    double largest = 0;
    Vec3 sum{};
    std::uint32_t count = 0;
    Vec3 lower{1, 1, 1}, upper{-1, -1, -1};  // a box around their directions
    void add(const Vec3& acceleration) noexcept;
    double min_along(const Vec3& way) const noexcept;  // of the directions' cosines with it, a lower bound
  };
  struct Track {
    // The promise.
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
