#pragma once
#include <cstdint>

namespace orchard::runtime::test {

// splitmix64: a stream of numbers for each seed. Counter-free, unlike the library's: tests need streams.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  double uniform(double lower, double upper) {
    return lower + (upper - lower) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }

 private:
  std::uint64_t state_;
};

}  // namespace orchard::runtime::test
