#include "batch/batch_progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace orchard::apps {

BatchProgress::BatchProgress(std::size_t meshes, bool wanted)
    : meshes_(meshes), active_(wanted && isatty(STDERR_FILENO)) {}

void BatchProgress::add(bool worked_on, bool failed) {
  ++done_;
  worked_on_ += worked_on ? 1 : 0;
  failed_ += failed ? 1 : 0;
  draw();
}

void BatchProgress::draw() {
  constexpr std::chrono::milliseconds kBetweenFrames{100};
  const Clock::time_point now = Clock::now();
  if (!active_ || (drawn_ && now - last_ < kBetweenFrames)) return;
  last_ = now;
  drawn_ = true;
  const double rate = static_cast<double>(worked_on_) / std::chrono::duration<double>(now - start_).count();
  std::string text = fmt::format("{} of {} meshes, {} failed", done_, meshes_, failed_);
  if (worked_on_ > 0)
    text +=
        fmt::format(", {:.3g} a second, {} left", rate, in_units_of_time(static_cast<double>(meshes_ - done_) / rate));
  fmt::print(stderr, "\r{:<70}", text);
  std::fflush(stderr);
}

void BatchProgress::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r{:70}\r", "");
  std::fflush(stderr);
  drawn_ = false;
}

std::string in_units_of_time(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 100) return fmt::format("{} s", whole);
  const long long minutes = (whole + 59) / 60;
  if (minutes < 100) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

}  // namespace orchard::apps
