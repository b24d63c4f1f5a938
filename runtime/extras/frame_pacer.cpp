#include "orchard/runtime/frame_pacer.h"

#include <algorithm>
#include <cmath>

namespace orchard::runtime {
namespace {

constexpr double kMeanGain = 1.0 / 8, kDeviationGain = 1.0 / 4;  // RFC 6298
constexpr double kForget = 1.0 / 64;                             // how fast the largest value decays, per frame
constexpr double kShareOfLargest = 0.9;

}  // namespace

void FramePacer::Smoothed::add(double value) noexcept {
  deviation += kDeviationGain * (std::fabs(value - mean) - deviation);
  mean += kMeanGain * (value - mean);
  largest = std::max(value, largest - kForget * (largest - mean));
}

FramePacer::Duration FramePacer::predicted_rest() const noexcept {
  if (frames_ == 0) return frame_ / 2;
  const double guess = std::max(rest_.mean + deviations_ * rest_.deviation, kShareOfLargest * rest_.largest);
  return Duration(static_cast<Duration::rep>(std::min(guess, static_cast<double>(frame_.count()))));
}

void FramePacer::begin_frame(Time now) noexcept { begin_ = now; }

FramePacer::Duration FramePacer::begin_detection(Time now) noexcept {
  detection_begin_ = now;
  const auto excess = Duration(static_cast<Duration::rep>(excess_.mean + deviations_ * excess_.deviation));
  granted_ = std::max(Duration(0), frame_ - Duration(now - begin_) - predicted_rest() - excess);
  return granted_;
}

void FramePacer::end_detection(Time now) noexcept {
  detection_end_ = now;
  excess_.add(static_cast<double>(std::max(Duration(0), Duration(now - detection_begin_) - granted_).count()));
}

void FramePacer::end_frame(Time now) noexcept {
  const auto rest = static_cast<double>(Duration(now - detection_end_).count());
  if (frames_ == 0) rest_ = {rest, rest / 2, rest};
  rest_.add(rest);
  slack_ = frame_ - Duration(now - begin_);
  ++frames_;
  if (slack_ < Duration(0)) ++late_;
}

}  // namespace orchard::runtime
