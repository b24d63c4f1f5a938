#include "command_line/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace orchard::apps {

ProgressBar::ProgressBar(bool wanted) : active_(wanted && isatty(STDERR_FILENO)) {}

Progress ProgressBar::callback() {
  if (!active_) return {};
  return [this](std::string_view stage, double fraction) {
    draw(stage, fraction);
    return true;
  };
}

void ProgressBar::draw(std::string_view stage, double fraction) {
  constexpr int kWidth = 32;
  constexpr auto kBetweenFrames = std::chrono::milliseconds(50);
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && now - last_ < kBetweenFrames) return;
  last_ = now;
  drawn_ = true;
  const int filled = static_cast<int>(kWidth * std::clamp(fraction, 0.0, 1.0));
  fmt::print(stderr, "\r{:<24} [{:=<{}}{:<{}}] {:3.0f} %", stage, "", filled, "", kWidth - filled, 100 * fraction);
  std::fflush(stderr);
}

void ProgressBar::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r{:70}\r", "");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace orchard::apps
