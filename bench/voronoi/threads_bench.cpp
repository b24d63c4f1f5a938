// How many times as fast two threads are as one, in seconds of the wall clock (the best of two): ours, the certificate
// included, and CGAL's parallel Delaunay triangulation of the same points beside its sequential one. Only on an
// otherwise idle machine does that say anything. voronoi_threads_bench [number of points] [folder of the models]
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>

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

// In an arena of its own: after a tbb::global_control of one thread, one of two may go on with one.
double seconds(int threads, const std::function<void()>& run) {
  tbb::task_arena arena(threads);
  double best = 1e300;
  for (int i = 0; i < kRuns; ++i) {
    const auto start = std::chrono::steady_clock::now();
    arena.execute(run);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

bool same_bytes(const VoronoiDiagram& a, const VoronoiDiagram& b) {
  return a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(VoronoiVertex)) == 0;
}

void print(const char* name, const test::Points& points) {
  std::vector<Kernel::Point_3> cgal_points;
  for (const Point& p : points) cgal_points.emplace_back(p.x(), p.y(), p.z());
  const CGAL::Bbox_3 box = CGAL::bbox_3(cgal_points.begin(), cgal_points.end());
  VoronoiDiagram by_one, by_two;
  const double one = seconds(1, [&] { by_one = highest_first_voronoi(points).diagram; });
  const double two = seconds(2, [&] { by_two = highest_first_voronoi(points).diagram; });
  const double cgal = seconds(1, [&] { Delaunay(cgal_points.begin(), cgal_points.end()); });
  const double cgal_two = seconds(2, [&] {
    ParallelDelaunay::Lock_data_structure locks(box, kLockCells);
    ParallelDelaunay(cgal_points.begin(), cgal_points.end(), &locks);
  });
  const double metric_one = seconds(1, [&] { inaccuracies(by_one); }),
               metric_two = seconds(2, [&] { inaccuracies(by_one); });
  std::printf("%-20s %7zu %8.3f %8.3f %6.2f %5s  %8.3f %8.3f %6.2f  %8.3f %8.3f %6.2f\n", name, points.size(), one, two,
              one / two, same_bytes(by_one, by_two) ? "yes" : "NO", cgal, cgal_two, cgal / cgal_two, metric_one,
              metric_two, metric_one / metric_two);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const auto n = static_cast<Index>(argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 500000);
  const std::string data = argc > 2 ? argv[2] : "data";
  std::printf("%-20s %7s %8s %8s %6s %5s  %8s %8s %6s  %8s %8s %6s\n", "set", "points", "1 thread", "2 thr.", "ratio",
              "same", "CGAL", "2 thr.", "ratio", "metric", "2 thr.", "ratio");
  print("uniform", test::uniform_points(n, 1));
  print("bumpy sphere", test::bumpy_sphere_points(n, 1));
  for (const char* model : {"faucet", "lamp"}) {
    const Surface surface(read_mesh(data + "/" + model + ".obj"));
    print(model, sample_surface(surface, {.face_points = n - n / 5, .edge_points = n / 5}).points);
  }
}
