// CPU seconds on one thread of proving a merged tree of up to 585 spheres, and its parts.
// Usage: orchard_verify_bench MESH..
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/spheretree/certify.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/redundancy.h"
#include "orchard/spheretree/verify.h"
#include "trees.h"

namespace {

using namespace orchard;

double seconds_of(const std::function<void()>& work) {
  double best = 1e300;
  for (int run = 0; run < 3; ++run) {
    const double start = bench::cpu_seconds();
    work();
    best = std::min(best, bench::cpu_seconds() - start);
  }
  return best;
}

void measure_one(const char* file) {
  TriangleMesh mesh = read_mesh(file);
  repair_mesh(mesh);
  const Surface surface(std::move(mesh));
  SphereTree tree = bench::merged_tree(surface);
  measure(tree, surface);
  const auto packed = pack(tree, surface);
  bool ok = true;
  const double all = seconds_of([&] { ok = verify(surface, packed).ok() && ok; });
  const double path_rule = seconds_of([&] { ok = certify(surface, packed).complete() && ok; });
  SphereTree lean = tree;
  const double redundancy = seconds_of([&] {
    lean = tree;
    remove_redundant(lean, surface);
  });
  std::printf(
      "%-16s %7zu triangles, %3zu spheres: verify %.3f s, of that the path rule %.3f s; redundant spheres %.3f s%s\n",
      std::filesystem::path(file).stem().c_str(), surface.mesh().triangles.size(), tree.nodes.size(), all, path_rule,
      redundancy, ok ? "" : "  NOT PROVEN");
}

}  // namespace

int main(int argc, char** argv) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  for (int i = 1; i < argc; ++i) measure_one(argv[i]);
}
