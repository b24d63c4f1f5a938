// One parent's eight children against eight of the other tree: the narrow phase's inner loop against the minimum that
// any such loop must do with the same vectors, and against its own form of one number at a time.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

#include "collision/kernels/sphere_block.h"
#include "simd/machine.h"
#include "simd/vector_support.h"
#include "support.h"

namespace {

using namespace orchard::runtime;
using namespace orchard::runtime::detail;

#ifdef ORCHARD_VECTORS
// Moves eight centres and tests 64 pairs; keeps nothing but a bit for each.
ORCHARD_INLINE std::uint64_t pairs_met(const SiblingBlock& rows, const SiblingBlock& lanes,
                                       const Placement& p) noexcept {
  using Floats = VectorFloats::Floats;
  using Words __attribute__((vector_size(32))) = std::int32_t;
  using Bytes __attribute__((vector_size(8))) = std::uint8_t;
  const Floats x = load<Floats>(lanes.x), y = load<Floats>(lanes.y), z = load<Floats>(lanes.z),
               radius = load<Floats>(lanes.radius) + spread<Floats>(p.slack);
  const auto moved = [&](std::size_t i) ORCHARD_INLINE_LAMBDA -> Floats {
    return spread<Floats>(p.rotation[3 * i]) * x + spread<Floats>(p.rotation[3 * i + 1]) * y +
           spread<Floats>(p.rotation[3 * i + 2]) * z + spread<Floats>(p.translation[i]);
  };
  const Floats cx = moved(0), cy = moved(1), cz = moved(2);
  Words met = {};
  for (std::size_t r = 0; r < 8; ++r) {
    const Floats dx = cx - spread<Floats>(rows.x[r]), dy = cy - spread<Floats>(rows.y[r]),
                 dz = cz - spread<Floats>(rows.z[r]), reach = radius + spread<Floats>(rows.radius[r]);
    met |= (dx * dx + dy * dy + dz * dz <= reach * reach) & (1 << r);
  }
  const Bytes bytes = __builtin_convertvector(met, Bytes);
  std::uint64_t result;
  std::memcpy(&result, &bytes, sizeof result);
  return result;
}
#endif

template <typename Run>
double nanoseconds(std::size_t blocks, Run&& run) {
  double best = 1e300;
  for (int pass = 0; pass < 20; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    for (int repeat = 0; repeat < 50; ++repeat) {
      for (std::size_t i = 0; i < blocks; ++i) run(i);
    }
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / (50.0 * static_cast<double>(blocks)));
  }
  return best;
}

}  // namespace

int main() {
  constexpr std::size_t blocks = 64;  // in the first cache
  std::vector<SiblingBlock> first(blocks), second(blocks);
  test::Draw draw(1);
  const auto fill = [&draw](SiblingBlock& block) {
    for (std::size_t i = 0; i < 8; ++i) {
      const auto number = [&draw](double low, double high) { return static_cast<float>(draw.uniform(low, high)); };
      block.x[i] = number(-1, 1), block.y[i] = number(-1, 1), block.z[i] = number(-1, 1);
      block.radius[i] = number(0.1, 0.3), block.error[i] = number(0.1, 0.2), block.depth[i] = number(-0.1, 0.1);
      block.link[i] = 8;
    }
  };
  for (auto& block : first) fill(block);
  for (auto& block : second) fill(block);
  Placement placement{};
  const Pose pose = draw.pose(1.2);
  for (std::size_t i = 0; i < 9; ++i) placement.rotation[i] = placement.turn[i] = static_cast<float>(pose.rotation[i]);
  for (std::size_t i = 0; i < 3; ++i) placement.translation[i] = static_cast<float>(pose.translation[i]);
  placement.scale = 1, placement.slack = 1e-6f;
  LevelState level{};
  level.min_excess.fill(std::numeric_limits<float>::max());
  level.best_inner = level.best_leaf = 0.05f;
  BlockHits hits{};
  std::uint64_t sum = 0;
  const auto pair = [&](std::size_t i) { return BlockPair{&first[i], &second[i], 0, 8, 8, true}; };
  const double ours =
      nanoseconds(blocks, [&](std::size_t i) { test_block(pair(i), placement, level, hits), sum += hits.meeting; });
  const Machine best = best_machine();
  use_machine(Machine::portable);
  const double portable =
      nanoseconds(blocks, [&](std::size_t i) { test_block(pair(i), placement, level, hits), sum += hits.meeting; });
  use_machine(best);
  std::printf("%-52s %7.1f ns\n", "orchard: 64 tests, gaps and separation bounds kept", ours);
#ifdef ORCHARD_VECTORS
  const double limit =
      nanoseconds(blocks, [&](std::size_t i) { sum += PerMachine<pairs_met>::call(first[i], second[i], placement); });
  std::printf("%-52s %7.1f ns\n", "limit: 64 tests, one bit each", limit);
  std::printf("%-52s %7.2f\n", "ratio", ours / limit);
#endif
  std::printf("%-52s %7.1f ns\n", "orchard, one number at a time", portable);
  return sum == 0;
}
