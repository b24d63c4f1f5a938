// Appendix B: the sweep for shapes with monotone boundaries against the general algorithm, the boundary lemma on
// intervals:
//   appendix_b_sweep [arrangements]
// Random disks, rectangles and convex polygons over a square, 3 to 28 at a time, 10^6 times; then ever more disks, just
// large enough to cover it in about half of the cases. Exits with 1 if the two ever give different answers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "construction_methods/arrangement.h"
#include "construction_methods/cover_sweep.h"

namespace {

using namespace orchard;
using namespace orchard::construction_methods;
using Clock = std::chrono::steady_clock;

const std::vector<PlanePoint> kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

struct Sums {
  std::size_t arrangements = 0, shapes = 0, covered = 0, differ = 0, crossings = 0;
  double general[2] = {0, 0}, sweep[2] = {0, 0};  // seconds: not covered, covered

  void add(const std::vector<PlanarShape>& set) {
    const auto begin = Clock::now();
    const bool is_covered = cover_of_polygon(kSquare, set).covered;
    const auto middle = Clock::now();
    const SweptCover swept = cover_by_sweep(kSquare, set);
    const auto end = Clock::now();
    ++arrangements, shapes += set.size(), covered += is_covered, differ += is_covered != swept.covered;
    crossings += swept.crossings;
    general[is_covered] += std::chrono::duration<double>(middle - begin).count();
    sweep[is_covered] += std::chrono::duration<double>(end - middle).count();
  }

  void print(const std::string& name) const {
    const auto n = static_cast<double>(arrangements), yes = static_cast<double>(std::max<std::size_t>(1, covered));
    const auto no = static_cast<double>(std::max<std::size_t>(1, arrangements - covered));
    std::printf("| %s | %zu | %.0f | %.0f %% | %.0f | %.1f, %.1f | %.1f, %.1f | %.2f, %.2f | %zu |\n", name.c_str(),
                arrangements, static_cast<double>(shapes) / n, 100 * static_cast<double>(covered) / n,
                static_cast<double>(crossings) / n, 1e6 * general[1] / yes, 1e6 * general[0] / no, 1e6 * sweep[1] / yes,
                1e6 * sweep[0] / no, general[1] / std::max(sweep[1], 1e-12), general[0] / std::max(sweep[0], 1e-12),
                differ);
    std::fflush(stdout);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const std::size_t arrangements = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  std::printf(
      "| shapes | arrangements | shapes each | covered | crossings | general: covered, not, microseconds | sweep | "
      "general over "
      "sweep | answers that differ |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  Sums mixed;
  for (std::size_t seed = 0; seed < arrangements; ++seed) mixed.add(random_arrangement(seed));
  mixed.print("disks, rectangles, polygons");
  std::size_t differ = mixed.differ;
  for (const std::size_t count : {30u, 100u, 300u, 1000u, 3000u}) {
    Sums disks;
    const std::size_t sets = std::clamp<std::size_t>(arrangements / (10 * count), 3, 300);
    for (std::size_t seed = 0; seed < sets; ++seed) disks.add(many_disks(count, seed));
    disks.print(std::to_string(count) + " disks");
    differ += disks.differ;
  }
  return differ == 0 ? 0 : 1;
}
