#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace orchard::runtime {

// Keeps frames to a length (dissertation 7.3): says how long collision detection may take in each, and measures.
//
//   FramePacer pacer(std::chrono::milliseconds(16));
//   for (;;) {
//     pacer.begin_frame();
//     input, behaviour ..
//     const Frame frame = world.step(time, {.time = pacer.begin_detection()});
//     pacer.end_detection();
//     respond, draw ..
//     pacer.end_frame();             // pacer.slack() is left: wait, or do something useful
//   }
//
// The dissertation predicts the whole non-detection time of a frame to be that of the last one. Here only what comes
// *after* detection is predicted, as what comes before is measured by then; and the prediction is the mean of recent
// frames plus `deviations` times their mean deviation, both smoothed exponentially as round-trip times are in TCP
// (Jacobson 1988; RFC 6298), and no less than a share of the largest one lately. Half of the frames take longer than a
// good guess of the mean: what is wanted is a guess that is seldom exceeded. A detection that took longer than it was
// granted lowers later grants by what it exceeded, smoothed in the same way.
class FramePacer {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  using Duration = std::chrono::nanoseconds;

  explicit FramePacer(Duration frame, double deviations = 4) noexcept : frame_(frame), deviations_(deviations) {}

  void begin_frame(Time now = Clock::now()) noexcept;
  // How long detection may take from now on; 0 if the frame is late already.
  Duration begin_detection(Time now = Clock::now()) noexcept;
  void end_detection(Time now = Clock::now()) noexcept;
  void end_frame(Time now = Clock::now()) noexcept;

  Duration frame() const noexcept { return frame_; }
  Duration granted() const noexcept { return granted_; }      // to the last detection
  Duration detection() const noexcept { return detection_; }  // what it took
  Duration slack() const noexcept { return slack_; }          // of the last frame; below 0: it was late by so much
  std::uint64_t frames() const noexcept { return frames_; }
  std::uint64_t late() const noexcept { return late_; }  // frames that were
  Duration predicted_rest() const noexcept;              // of the frame, after detection

 private:
  struct Smoothed {
    double mean = 0, deviation = 0, largest = 0;
    bool any = false;
    void add(double value) noexcept;
  };

  Duration frame_;
  double deviations_;
  Time begin_{}, detection_begin_{}, detection_end_{};
  Duration granted_{0}, detection_{0}, slack_{0};
  Smoothed rest_, excess_;
  std::uint64_t frames_ = 0, late_ = 0;
};

}  // namespace orchard::runtime
