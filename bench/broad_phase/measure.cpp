#include "measure.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>

#include "worlds.h"

namespace orchard::bench {

Stopwatch::Stopwatch(bool processor) : processor_(processor) {
  overhead_ = 1;
  for (int i = 0; i < 2000; ++i) {
    const double begin = now();
    overhead_ = std::min(overhead_, now() - begin);
  }
}

double Stopwatch::now() const {
  if (processor_) {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double Stopwatch::since(double begin) const { return std::max(0.0, now() - begin - overhead_); }

double Result::total() const {
  double sum = 0;
  for (const double s : steps) sum += s;
  return sum;
}

double Result::worst(std::size_t from) const {
  double most = 0;
  for (std::size_t i = from; i < steps.size(); ++i) most = std::max(most, steps[i]);
  return most;
}

void Result::keep_fastest(const Result& other) {
  if (steps.empty()) {
    *this = other;
    return;
  }
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = std::min(steps[i], other.steps[i]);
}

std::uint64_t checksum(std::span<const runtime::BodyPair> pairs) {
  std::uint64_t sum = pairs.size();
  for (const runtime::BodyPair& p : pairs) {
    runtime::test::Draw mixed(std::uint64_t{p.a} << 32 | p.b);
    sum += mixed.bits();
  }
  return sum;
}

bool same(const char* name, const Result& a, const Result& b) {
  for (std::size_t i = 0; i < std::min(a.pairs.size(), b.pairs.size()); ++i) {
    if (a.pairs[i] == b.pairs[i]) continue;
    std::printf("%s reports other pairs at step %zu\n", name, i);
    return false;
  }
  return true;
}

}  // namespace orchard::bench
