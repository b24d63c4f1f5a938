// The boundary lemma with many disks on one triangle, beside looking at all pairs; and one changed sphere of a tree
// beside checking everything from scratch. CPU seconds, one thread.
// Usage: orchard_lemma_bench MESH..
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "lemma_check.h"
#include "orchard/covering/coverage.h"
#include "orchard/covering/incremental_cover.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/repair.h"
#include "trees.h"

namespace {

using namespace orchard;

const std::array<Point, 3> kTriangle{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};

// A lattice that just covers the triangle, shuffled.
std::vector<PathBall> lattice(Index side) {
  std::vector<PathBall> balls;
  for (Index i = 0; i <= side; ++i)
    for (Index j = 0; i + j <= side + 1; ++j) balls.push_back({Point(i, j, 0) / side, 0.72 / side, kNone, true});
  Random random(1, 1);
  for (std::size_t i = balls.size(); i > 1; --i) std::swap(balls[i - 1], balls[random.below(i)]);
  return balls;
}

// Figure 5.17 as printed: every circle against every disk.
bool covered_by_all_pairs(const std::vector<PathBall>& balls) {
  const detail::TrianglePlane plane(kTriangle);
  std::vector<detail::Disk> disks;
  for (const PathBall& ball : balls) disks.push_back(plane.project(ball.center, ball.radius));
  detail::CircleIntervals needed;
  for (std::size_t i = 0; i < disks.size(); ++i) {
    if (disks[i].radius <= 0) continue;
    plane.clip_to_region(disks[i], needed);
    for (std::size_t k = 0; k < disks.size(); ++k)
      if (k != i && disks[k].radius > 0) needed.subtract(plane.inside_of(disks[i], disks[k]));
    if (!needed.empty()) return false;
  }
  return true;
}

void many_disks() {
  std::puts("disks on one triangle; seconds; all pairs; times as fast");
  for (const Index side : {15u, 31u, 63u, 127u}) {
    const auto balls = lattice(side);
    double start = bench::cpu_seconds();
    const int repeats = side < 60 ? 20 : 2;
    bool ok = true;
    for (int i = 0; i < repeats; ++i) ok = triangle_covered(kTriangle, balls) && ok;
    const double ours = (bench::cpu_seconds() - start) / repeats;
    start = bench::cpu_seconds();
    ok = covered_by_all_pairs(balls) && ok;
    const double pairs = bench::cpu_seconds() - start;
    std::printf("%6zu  %9.5f  %9.5f  %6.1f%s\n", balls.size(), ours, pairs, pairs / ours, ok ? "" : "  NOT COVERED");
  }
}

void changes(const char* file) {
  TriangleMesh mesh = read_mesh(file);
  repair_mesh(mesh);
  const Surface surface(std::move(mesh));
  const SphereTree tree = bench::merged_tree(surface);
  double start = bench::cpu_seconds();
  const bool complete = surface_coverage(surface, path_balls(tree)).complete();
  const double from_scratch = bench::cpu_seconds() - start;
  IncrementalCover kept(surface, path_balls(tree));
  Random random(1, 2);
  constexpr int kChanges = 2000;
  int taken = 0;
  const std::uint64_t before = kept.triangles_checked();
  start = bench::cpu_seconds();
  for (int i = 0; i < kChanges; ++i) {
    const auto ball = static_cast<Index>(random.below(kept.balls().size()));
    const PathBall old = kept.balls()[ball];
    const Vector step(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    taken += kept.try_change(ball, {old.center + 0.02 * old.radius * step, old.radius * random.uniform(0.97, 1.02)});
  }
  const double each = (bench::cpu_seconds() - start) / kChanges;
  std::printf(
      "%s: %zu triangles, %zu spheres%s: all %.4f s; a change %.6f s, %.1f triangles, %.0f times as fast; %d of %d "
      "taken\n",
      std::filesystem::path(file).stem().c_str(), surface.mesh().triangles.size(), tree.nodes.size(),
      complete ? "" : " NOT COVERED", from_scratch, each,
      static_cast<double>(kept.triangles_checked() - before) / kChanges, from_scratch / each, taken, kChanges);
}

}  // namespace

int main(int argc, char** argv) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  many_disks();
  std::puts("\none sphere of a tree changes a little, as in annealing");
  for (int i = 1; i < argc; ++i) changes(argv[i]);
}
