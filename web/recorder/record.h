#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "orchard/runtime/orchard.h"

namespace orchard::web {

// What is asked, as web/test/replay.mjs knows it.
enum class Kind : std::uint8_t {
  pose,
  collide,
  levels,
  distance,
  collide_again,
  nearest_point,
  cast_ray,
  inside,
  closer_than,
  contacts,
  signed_distance,
  batch,
  broad_phase,
  detector,
};

// Numbers in the order in which they are added: all of a recording are doubles.
struct Row {
  std::vector<double> numbers;

  template <typename... Numbers>
  Row& add_all(Numbers... more) {
    (numbers.push_back(static_cast<double>(more)), ...);
    return *this;
  }
  Row& add(const double* from, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(from[i]);
    return *this;
  }
  Row& add(const orchard_pose& pose) { return add(pose.rotation, 9).add(pose.translation, 3).add_all(pose.scale); }
  Row& add(const orchard_verdict& verdict);
};

// A recording: a count, then for each query its kind, its arguments and its answers, each after their number.
class Recording {
 public:
  void add(Kind kind, const Row& arguments, const Row& answers);
  std::size_t count() const { return count_; }
  bool write(const char* path) const;

 private:
  std::size_t count_ = 0;
  std::vector<double> numbers_;
};

// The same draws with every standard library.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : bits_(seed) {}
  double uniform(double from, double to) { return from + (to - from) * (static_cast<double>(bits_() >> 11) * 0x1p-53); }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }

 private:
  std::mt19937_64 bits_;
};

// A world of moving bodies, step by step.
void record_broad_phase(Recording& recording, Draws& draws);
void record_detector(Recording& recording, Draws& draws, const std::vector<orchard_tree*>& trees);

}  // namespace orchard::web
