#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace orchard::apps {

// Prints "412 of 10000 meshes, 9 failed, 3.4 a second, 47 min left" on one line of standard error if that is a terminal
// and `wanted`; otherwise nothing. The rate counts only meshes that were processed, not those with stored results.
class BatchProgress {
 public:
  BatchProgress(std::size_t meshes, bool wanted);
  ~BatchProgress() { clear(); }
  BatchProgress(const BatchProgress&) = delete;
  BatchProgress& operator=(const BatchProgress&) = delete;

  void add(bool worked_on, bool failed);
  void draw();  // ten times a second at most
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t meshes_, done_ = 0, worked_on_ = 0, failed_ = 0;
  bool active_, drawn_ = false;
  Clock::time_point start_ = Clock::now(), last_{};
};

// "47 min", "3 h 20 min", "12 s".
std::string in_units_of_time(double seconds);

}  // namespace orchard::apps
