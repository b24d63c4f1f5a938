#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

// Keeps frames to a length (dissertation 7.3): computes how long collision detection may take in each, and measures it.
namespace orchard::runtime {

// A pacer of frames:
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
// The dissertation predicts that the whole non-detection time of a frame equals that of the last one. This class
// predicts only the time *after* detection, since the time before it is measured by then. The prediction is the mean of
// recent frames plus `deviations` times their mean deviation, both smoothed exponentially as round-trip times are in
// TCP (Jacobson 1988; RFC 6298), and at least a share of the largest recent one. The mean alone would be exceeded by
// half of the frames; the prediction should be exceeded seldom. A detection that took longer than granted lowers later
// grants by the excess, smoothed in the same way.
class FramePacer {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  using Duration = std::chrono::nanoseconds;

  explicit FramePacer(Duration frame, double deviations = 4) noexcept : frame_(frame), deviations_(deviations) {}

  void begin_frame(Time now = Clock::now()) noexcept;
  // Returns how long detection may take from now on; 0 if the frame is already late.
  Duration begin_detection(Time now = Clock::now()) noexcept;
  void end_detection(Time now = Clock::now()) noexcept;
  void end_frame(Time now = Clock::now()) noexcept;

  Duration granted() const noexcept { return granted_; }  // The time granted to the last detection.
  Duration slack() const noexcept { return slack_; }      // The time left of the last frame; below 0 if it was late.
  std::uint64_t frames() const noexcept { return frames_; }
  std::uint64_t late() const noexcept { return late_; }  // The number of late frames.
  Duration predicted_rest() const noexcept;              // The predicted time of the frame after detection.

 private:
  struct Smoothed {
    double mean = 0, deviation = 0, largest = 0;
    void add(double value) noexcept;
  };

  Duration frame_;
  double deviations_;
  Time begin_{}, detection_begin_{}, detection_end_{};
  Duration granted_{0}, slack_{0};
  Smoothed rest_, excess_;
  std::uint64_t frames_ = 0, late_ = 0;
};

}  // namespace orchard::runtime
