// The tests that 7.1 proposes: cubes under forces as in Figs. 7.2 to 7.10, but with subsequences that are related:
//   sec_7_1_related [folder for CSV] [trials]
// 100 cubes, until two collide or 3 seconds have passed, by the methods with space-time bounds and by octrees against
// Turk's spatial hash. Detection alone, the best of three runs. Exits with 1 if two methods find different collisions.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "broad_phase_methods/sleeping_broad_phase.h"
#include "cubes.h"

namespace {

using namespace orchard::bench;
using orchard::broad_phase_methods::SleepingMethod;
using orchard::runtime::BroadPhase;
using orchard::runtime::MotionSource;

constexpr std::size_t kCubes = 100;
constexpr double kBall = 107;  // as in Fig. 7.3

struct Named {
  const char* name;
  Relation relation;
};
constexpr Named kRelations[] = {{"none, as published", Relation::none},
                                {"steady: M and d stay", Relation::steady},
                                {"turning: d by 30 degrees, M by a tenth", Relation::turning},
                                {"alternating: d reversed", Relation::alternating},
                                {"shared: all cubes alike", Relation::shared}};

struct Way {
  const char* name;
  std::function<Run(const CubeScene&)> run;
};

std::vector<Way> ways() {
  const auto sleeping = [](SleepingMethod method) {
    return [=](const CubeScene& scene) {
      return run_bounds(scene, [=](MotionSource source) {
        return orchard::broad_phase_methods::make_sleeping_broad_phase(
            std::move(source), {.method = method, .common = {.time_step = kDetection}});
      });
    };
  };
  static const double cell = best_cell({kCubes, kBall, 1});
  return {{"hash", [](const CubeScene& scene) { return run_rival(scene, hash_of(0, cell)); }},
          {"octree, updated",
           [](const CubeScene& scene) { return run_rival(scene, octree_of(MovingOctree::Upkeep::updated)); }},
          {"projection", sleeping(SleepingMethod::projection)},
          {"horns", sleeping(SleepingMethod::horns)},
          {"events", [](const CubeScene& scene) {
             return run_bounds(
                 scene, [](MotionSource source) { return BroadPhase(std::move(source), {.time_step = kDetection}); });
           }}};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Run best_of_three(const Way& way, const CubeScene& scene) {
  Run best = way.run(scene);
  for (int round = 0; round < 2; ++round) best.detection = std::min(best.detection, way.run(scene).detection);
  return best;
}

// A row of the table; false if two ways find different collisions.
bool run(const Named& named, int trials, std::ofstream& csv) {
  const std::vector<Way> all = ways();
  std::vector<std::vector<double>> speedups(all.size());
  std::vector<double> collisions, asked;
  bool right = true;
  for (int trial = 0; trial < trials; ++trial) {
    const CubeScene scene{kCubes, kBall, static_cast<std::uint64_t>(trial) + 1, named.relation};
    std::vector<Run> runs;
    for (const Way& way : all) runs.push_back(best_of_three(way, scene));
    collisions.push_back(runs.front().collision);
    asked.push_back(static_cast<double>(runs.back().asked));
    for (std::size_t w = 0; w < all.size(); ++w) {
      right = right && std::fabs(runs[w].collision - runs.front().collision) < 1e-9;
      speedups[w].push_back(runs.front().detection / runs[w].detection);
      csv << '"' << named.name << "\"," << trial << ',' << all[w].name << ',' << runs[w].collision << ','
          << runs[w].detection << ',' << runs[w].asked << '\n';
    }
  }
  std::printf("| %s | %.2f | %.0f ", named.name, median(collisions), median(asked));
  for (std::size_t w = 1; w < all.size(); ++w) {
    const auto faster = std::count_if(speedups[w].begin(), speedups[w].end(), [](double s) { return s > 1; });
    std::printf("| %.2f (%.0f %%) ", median(speedups[w]), 100.0 * static_cast<double>(faster) / trials);
  }
  std::printf("|\n");
  std::fflush(stdout);
  return right;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const int trials = argc > 2 ? std::max(1, std::atoi(argv[2])) : 100;
  std::filesystem::create_directories(folder);
  std::ofstream csv(folder / "sec_7_1_related.csv");
  csv << "relation,trial,method,collision,detection,asked\n";
  std::printf("| subsequences (%d trials) | first collision, median s | motions asked, events ", trials);
  for (const Way& way : ways())
    if (way.name != std::string("hash")) std::printf("| %s: speedup over the hash (faster in) ", way.name);
  std::printf("|\n|---|--:|--:|--:|--:|--:|--:|\n");
  bool right = true;
  for (const Named& named : kRelations) right = run(named, trials, csv) && right;
  return right ? 0 : 1;
}
