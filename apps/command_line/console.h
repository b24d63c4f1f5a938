#pragma once
#include <chrono>
#include <string>
#include <string_view>

#include "orchard/geometry/progress.h"

namespace orchard::apps {

// A progress bar on stderr, if that is a terminal and --quiet is not given; else nothing.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  Progress callback();  // valid while the bar lives
  void clear();

 private:
  void draw(std::string_view stage, double fraction);
  bool active_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace orchard::apps
