// The broad phase in every scene of a table, against a spatial hash that is rebuilt at each step with the cell size
// that suits the scene best, in one run:
//   broad_phase_scenes [most bodies [part of a scene's name]]
// Times are of detection only, with what the application has to tell (cancel, remove, add); of each step the fastest of
// some runs. Our inner loops are those of each machine that this one can be. All report the same pairs at every step.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "measure.h"
#include "rivals.h"
#include "scenes.h"
#include "simd/machine.h"
#include "spatial_hash.h"

namespace {

using namespace orchard::bench;
using orchard::runtime::BroadPhase;
using orchard::runtime::test::SceneSpec;
using orchard::runtime::test::SceneWorld;
using orchard::runtime::test::TableScene;
namespace machines = orchard::runtime::detail;

constexpr std::uint64_t kSeed = 7;

struct Finder {
  std::function<std::span<const BodyPair>(const TableScene&)> find;  // of the scene's present step
  std::function<std::size_t()> memory_bytes = [] { return std::size_t{0}; };
};

Result measure(const SceneSpec& spec, int steps, const std::function<Finder(const TableScene&)>& make) {
  const Stopwatch watch(spec.bodies >= 3000);
  TableScene scene(spec, kSeed);
  Result result;
  const Finder finder = make(scene);
  for (int step = 0; step < steps; ++step, scene.next_step()) {
    const double begin = watch.begin();
    const auto pairs = finder.find(scene);
    result.steps.push_back(watch.since(begin));
    result.pairs.push_back(checksum(pairs));
    result.memory = std::max(result.memory, finder.memory_bytes());
  }
  result.whole = steps == spec.steps;
  return result;
}

Result ours(const SceneSpec& spec) {
  return measure(spec, spec.steps, [](const TableScene& scene) -> Finder {
    auto world = std::make_shared<SceneWorld>(scene, BroadPhase(scene.source(), {.time_step = TableScene::kStep}));
    return {[world](const TableScene& s) { return world->step(s).pairs; },
            [world] { return world->world().memory_bytes(); }};
  });
}

using MakeRival =
    std::function<std::unique_ptr<Rival>(const std::vector<Vec3>& positions, const std::vector<double>& radii)>;

Result rival(const SceneSpec& spec, int steps, const MakeRival& make) {
  return measure(spec, steps, [&](const TableScene& scene) -> Finder {
    std::shared_ptr<Rival> it = make(scene.positions(), scene.radii());
    auto pairs = std::make_shared<std::vector<BodyPair>>();
    return {[it, pairs](const TableScene&) {
      pairs->clear();
      it->find(*pairs);
      return std::span<const BodyPair>(*pairs);
    }};
  });
}

double best_cell_size(const SceneSpec& spec) {
  TableScene scene(spec, kSeed);
  std::vector<SpatialHash::State> states;
  for (int step = 0; step < spec.steps; ++step, scene.next_step()) {
    if (step == 0 || step == spec.steps / 2 || step == spec.steps - 1) states.push_back(scene.positions());
  }
  return SpatialHash::best_cell_size(states, scene.radii());
}

double mean_ms(const Result& r) { return 1e3 * r.total() / static_cast<double>(r.steps.size()); }

// Bullet's and FCL's trees, which are at their best in piles.
bool print_trees(const SceneSpec& spec, const Result& hash, const Result& own) {
  using Kind = orchard::runtime::test::SceneKind;
  if (spec.kind != Kind::pile_asleep && spec.kind != Kind::pile_jitter && spec.kind != Kind::pile_cancelled) {
    std::printf(" - | - |");
    return true;
  }
  bool right = true;
  const auto other = [&](const char* name, const MakeRival& make) {
    const int steps = std::min(spec.steps, 100);
    const Result r = rival(spec, steps, make);
    right = same(name, r, hash) && right;
    double part = 0;  // of our time, for the same steps
    for (int i = 0; i < steps; ++i) part += own.steps[static_cast<std::size_t>(i)];
    std::printf(" %.1f |", r.total() / part);
    std::fflush(stdout);
  };
  (void)other;
#ifdef ORCHARD_HAS_FCL
  other("FCL", fcl_tree);
#else
  std::printf(" - |");
#endif
#ifdef ORCHARD_HAS_BULLET
  other("Bullet", bullet_dbvt);
#else
  std::printf(" - |");
#endif
  return right;
}

// The hash's, and ours with the inner loops of each machine. They take turns, so that other work on this one is shared.
struct Row {
  Result hash;
  std::vector<Result> own;
};

Row measure_row(const SceneSpec& spec, std::span<const machines::Machine> kinds) {
  const int runs = spec.bodies <= 1000 ? 15 : spec.bodies <= 10000 ? 7 : spec.bodies <= 100000 ? 3 : 1;
  const double cell = best_cell_size(spec);
  Row row;
  row.own.resize(kinds.size());
  for (int run = 0; run < runs; ++run) {
    row.hash.keep_fastest(rival(spec, spec.steps, [cell](const auto& positions, const auto& radii) {
      return std::make_unique<SpatialHash>(positions, radii, SpatialHash::Options{cell});
    }));
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      machines::use_machine(kinds[k]);
      row.own[k].keep_fastest(ours(spec));
    }
  }
  return row;
}

bool print_row(const SceneSpec& spec) {
  constexpr std::array kAll = {machines::Machine::base, machines::Machine::avx2, machines::Machine::avx512};
  const std::size_t can = static_cast<std::size_t>(
      std::count_if(kAll.begin(), kAll.end(), [](machines::Machine m) { return m <= machines::best_machine(); }));
  const Row row = measure_row(spec, std::span(kAll).first(can));
  const Result &hash = row.hash, &own = row.own.back();
  bool right = true;
  for (const Result& result : row.own) right = same("orchard", result, hash) && right;
  std::printf("| %s | %zu | %.4f | %.4f | %.4f | %.4f |", spec.name, spec.bodies, mean_ms(hash), 1e3 * hash.worst(1),
              mean_ms(own), 1e3 * own.worst(1));
  for (std::size_t k = 0; k < kAll.size(); ++k) {
    k < can ? std::printf(" %.2f |", hash.total() / row.own[k].total()) : std::printf(" - |");
  }
  std::printf(" %.2f | %.0f |", hash.worst(1) / own.worst(1),
              static_cast<double>(own.memory) / static_cast<double>(spec.bodies));
  right = print_trees(spec, hash, own) && right;
  std::printf("\n");
  std::fflush(stdout);
  return right;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t most = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000000;
  const std::string part = argc > 2 ? argv[2] : "";
  std::printf(
      "| scene | bodies | hash, ms a step | its worst | orchard, ms a step | its worst later | hash / orchard, SSE2 | "
      "AVX2 | AVX-512 | worst / worst | bytes a body | FCL / orchard | Bullet / orchard |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool right = true;
  for (const SceneSpec& spec : orchard::runtime::test::table_scenes(most)) {
    if (std::string(spec.name).find(part) != std::string::npos) right = print_row(spec) && right;
  }
  return right ? 0 : 1;
}
