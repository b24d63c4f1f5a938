#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/runtime/broad_phase.h"

// What the benchmarks of the broad phase measure with.
namespace orchard::bench {

// Processor time where that is fine enough, so that other work on the machine does not count; else the time of day.
class Stopwatch {
 public:
  explicit Stopwatch(bool processor);

  double now() const;  // seconds
  // The same, read twice: the first reading, after other work, takes longer than the overhead is.
  double begin() const {
    now();
    return now();
  }
  double since(double begin) const;

 private:
  bool processor_;
  double overhead_;  // of two readings with nothing between them
};

struct Result {
  std::vector<double> steps;         // seconds of each step
  std::vector<std::uint64_t> pairs;  // a checksum of each step's pairs
  std::size_t memory = 0;            // bytes, the most there were
  std::uint64_t asked = 0;
  bool whole = true;  // all steps were run

  double total() const;
  double worst(std::size_t from) const;
  // Of each step the faster one. The first result is taken as it is.
  void keep_fastest(const Result& other);
};

// Order does not matter.
std::uint64_t checksum(std::span<const runtime::BodyPair> pairs);

// Whether both report the same pairs at every step that both have; prints the first one that they do not.
bool same(const char* name, const Result& a, const Result& b);

}  // namespace orchard::bench
