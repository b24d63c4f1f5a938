// What each kind of vectors is worth: exact answers and distances by the inner loops of every machine that this one can
// be, against FCL in float at the same poses in the same run:  machines_bench [-n approaches] body.obj|body.orchard ..
// Built a second time without vectors (machines_bench_plain), as other compilers than GCC and Clang do it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "bodies.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/narrow_phase.h"
#include "rival.h"
#include "simd/machine.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;
using detail::Machine;

constexpr int kPasses = 5;

// The mean over all queries of the best of a few passes, in microseconds. A pass asks every query once: one that is
// asked again at once takes all its branches as foreseen, as none does that is asked for an answer.
double mean_of_best(const std::function<void(std::size_t)>& run, std::size_t queries) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> best(queries, 1e300);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t i = 0; i < queries; ++i) {
      const auto start = Clock::now();
      run(i);
      best[i] = std::min(best[i], std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    }
  }
  return std::accumulate(best.begin(), best.end(), 0.0) / static_cast<double>(queries);
}

std::vector<std::pair<Machine, std::string>> machines() {
#ifdef ORCHARD_NO_VECTORS
  return {{Machine::base, "plain"}};
#else
  std::vector<std::pair<Machine, std::string>> all = {
      {Machine::base, "SSE2"}, {Machine::avx2, "AVX2"}, {Machine::avx512, "AVX-512"}};
#ifndef ORCHARD_MACHINES
  all[0].second = "this build's only one";
#endif
  std::erase_if(all, [](const auto& m) { return m.first > detail::best_machine(); });
  return all;
#endif
}

void measure(const char* name, const PackedSphereTree& tree, std::size_t count) {
  const auto queries = approaches(tree, count, 0);
  const PreparedTree body(tree);
  NarrowPhase pair(body, body);
  DistanceQuery query(body, body);
  const std::vector<std::function<void(std::size_t)>> questions = {
      [&](std::size_t i) {
        pair.start(queries[i].a, queries[i].b);
        pair.refine_exactly();
      },
      [&](std::size_t i) {
        query.start(queries[i].a, queries[i].b, {.relative = 0, .absolute = 0});
        query.refine();
      },
      [&](std::size_t i) {
        query.start(queries[i].a, queries[i].b, {.relative = 0.01, .absolute = 0});
        query.refine();
      }};
  const auto rival = fcl_float(tree, tree);
  double theirs[2] = {0, 0};
  if (rival) {
    rival->place(queries);
    theirs[0] = mean_of_best([&](std::size_t i) { rival->collide(i); }, queries.size());
    theirs[1] = mean_of_best([&](std::size_t i) { rival->distance(i); }, queries.size());
  }
  for (const auto& [machine, machine_name] : machines()) {
    detail::use_machine(machine);
    std::printf("%-22s %-22s", name, machine_name.c_str());
    for (std::size_t q = 0; q < questions.size(); ++q) {
      const double ours = mean_of_best(questions[q], queries.size());
      std::printf(" %9.2f", ours);
      if (rival) std::printf(" %6.3f", ours / theirs[q == 0 ? 0 : 1]);
    }
    std::printf("\n");
  }
  detail::use_machine(detail::best_machine());
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 60;
  bool any = false;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "-n" && i + 1 < argc) {
      count = static_cast<std::size_t>(std::atoi(argv[++i]));
      continue;
    }
#ifndef ORCHARD_NO_VECTORS
    if (!any) {
      std::printf("%-22s %-22s %16s %16s %16s\n", "body", "loops", "exact answer", "distance, exact",
                  "distance to 1 %");
    }
#endif
    any = true;
    const std::string path = argv[i];
    const std::string name = path.substr(path.rfind('/') + 1);
    measure(name.c_str(), read_body(path), count);
    std::fflush(stdout);
  }
  if (!any) std::fprintf(stderr, "usage: machines_bench [-n approaches] body.obj|body.orchard ..\n");
  return any ? 0 : 2;
}
