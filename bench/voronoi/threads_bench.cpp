// How many times as fast two threads are as one, in seconds of the wall clock (the best of two): ours, the certificate
// included, and CGAL's parallel Delaunay triangulation of the same points beside its sequential one. Only on an
// otherwise idle machine does that say anything. voronoi_threads_bench [number of points] [folder of the models]
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/quality.h"
#include "voronoi/point_sets.h"

namespace {

using namespace orchard;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel>;
using ParallelDelaunay = CGAL::Delaunay_triangulation_3<
    Kernel, CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_3<Kernel>,
                                                 CGAL::Delaunay_triangulation_cell_base_3<Kernel>, CGAL::Parallel_tag>>;

constexpr int kRuns = 2;
constexpr int kLockCells = 50;  // along each axis, as CGAL's manual has it

// What a process of its own finds, that has so many threads from its start: one that was held to one thread may go on
// with one. The parent never starts any.
double apart(std::size_t threads, const std::function<double()>& find) {
  int channel[2];
  if (pipe(channel) != 0) std::abort();
  std::fflush(stdout);
  if (fork() == 0) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const double found = find();
    _exit(write(channel[1], &found, sizeof found) == sizeof found ? 0 : 1);
  }
  double found = 0;
  wait(nullptr);
  if (read(channel[0], &found, sizeof found) != sizeof found) std::abort();
  close(channel[0]);
  close(channel[1]);
  return found;
}

double seconds(const std::function<void()>& run) {
  double best = 1e300;
  for (int i = 0; i < kRuns; ++i) {
    const auto start = std::chrono::steady_clock::now();
    run();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

// The first half of a hash of the vertices' bytes, which a double holds.
double digest(const VoronoiDiagram& diagram) {
  const std::string_view bytes(reinterpret_cast<const char*>(diagram.vertices.data()),
                               diagram.vertices.size() * sizeof(VoronoiVertex));
  return static_cast<double>(std::hash<std::string_view>{}(bytes) >> 32);
}

// Points that processes share.
std::span<const Point> shared_points(std::size_t n, const std::function<test::Points()>& make) {
  void* const room = mmap(nullptr, n * sizeof(Point), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) std::abort();
  auto* const points = static_cast<Point*>(room);
  const double made = apart(2, [&] {
    const test::Points all = make();
    const std::size_t count = std::min(n, all.size());
    std::uninitialized_copy_n(all.begin(), count, points);
    return static_cast<double>(count);
  });
  return {points, static_cast<std::size_t>(made)};
}

void print(const char* name, std::size_t n, const std::function<test::Points()>& make) {
  const std::span<const Point> points = shared_points(n, make);
  const auto ours = [&] { return seconds([&] { highest_first_voronoi(points); }); };
  const auto bytes = [&] { return digest(highest_first_voronoi(points).diagram); };
  const auto metric = [&] {
    const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
    return seconds([&] { inaccuracies(diagram); });
  };
  std::vector<Kernel::Point_3> cgal_points;
  for (const Point& p : points) cgal_points.emplace_back(p.x(), p.y(), p.z());
  const CGAL::Bbox_3 box = CGAL::bbox_3(cgal_points.begin(), cgal_points.end());
  const auto cgal = [&] { return seconds([&] { Delaunay(cgal_points.begin(), cgal_points.end()); }); };
  const auto parallel_cgal = [&] {
    return seconds([&] {
      ParallelDelaunay::Lock_data_structure locks(box, kLockCells);
      ParallelDelaunay(cgal_points.begin(), cgal_points.end(), &locks);
    });
  };
  const double one = apart(1, ours), two = apart(2, ours), cgal_one = apart(1, cgal),
               cgal_two = apart(2, parallel_cgal), metric_one = apart(1, metric), metric_two = apart(2, metric);
  std::printf("%-20s %7zu %8.3f %8.3f %6.2f %5s  %8.3f %8.3f %6.2f  %8.3f %8.3f %6.2f\n", name, points.size(), one, two,
              one / two, apart(1, bytes) == apart(2, bytes) ? "yes" : "NO", cgal_one, cgal_two, cgal_one / cgal_two,
              metric_one, metric_two, metric_one / metric_two);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto n = static_cast<Index>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 500000);
  const std::string data = argc > 2 ? argv[2] : "data";
  std::printf("%-20s %7s %8s %8s %6s %5s  %8s %8s %6s  %8s %8s %6s\n", "set", "points", "1 thread", "2 thr.", "ratio",
              "same", "CGAL", "2 thr.", "ratio", "metric", "2 thr.", "ratio");
  print("uniform", n, [n] { return test::uniform_points(n, 1); });
  print("bumpy sphere", n, [n] { return test::bumpy_sphere_points(n, 1); });
  print("faucet", n, [&] {
    const Surface surface(read_mesh(data + "/faucet.obj"));
    return sample_surface(surface, {.face_points = n - n / 5, .edge_points = n / 5}).points;
  });
}
