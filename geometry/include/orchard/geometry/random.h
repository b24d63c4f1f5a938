#pragma once
#include <cstdint>

// Random numbers that do not depend on threads or on the standard library.
namespace orchard {

// A counter-based generator: item i of a stage draws the same numbers on any thread and in any order. The conversion
// from bits to values is orchard's own, because those of standard libraries differ.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stage, std::uint64_t item = 0)
      : state_(mix(mix(mix(seed) ^ stage) ^ item)) {}

  // Returns the next 64 random bits.
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15u;
    return mix(state_);
  }
  // Returns a number that is uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Returns a number that is uniform in [0, n), up to a bias below n / 2^64. Precondition: n > 0.
  std::uint64_t below(std::uint64_t n) { return bits() % n; }

 private:
  // The finaliser of SplitMix64 (Steele, Lea, Flood 2014).
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace orchard
