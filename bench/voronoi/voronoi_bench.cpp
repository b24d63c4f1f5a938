// Highest-first against CGAL's sequential Delaunay triangulation on the same points in the same run: seconds (the best
// of several), their ratio, how the insertions were decided, and bytes per point at the peak. voronoi_bench [largest
// number of points] [part of a set's name]
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>

#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/quality.h"
#include "voronoi/point_sets.h"

namespace {

using namespace orchard;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel>;

// Processor time: both sides run on one thread, and a busy machine disturbs it less.
double seconds(const std::function<void()>& run) {
  const std::clock_t start = std::clock();
  run();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// What running in a process of its own adds to the peak of the resident memory.
double peak_bytes(const std::function<void()>& run) {
  int channel[2];
  if (pipe(channel) != 0) return 0;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    const auto peak = [] {
      rusage usage{};
      getrusage(RUSAGE_SELF, &usage);
      return static_cast<double>(usage.ru_maxrss) * 1024;
    };
    const double before = peak();
    run();
    const double bytes = peak() - before;
    const bool written = write(channel[1], &bytes, sizeof bytes) == sizeof bytes;
    _exit(written ? 0 : 1);
  }
  double bytes = 0;
  if (read(channel[0], &bytes, sizeof bytes) != sizeof bytes) bytes = 0;
  waitpid(child, nullptr, 0);
  close(channel[0]);
  close(channel[1]);
  return bytes;
}

void compare(const char* name, const test::Points& points) {
  const int runs = points.size() > 200000 ? 3 : points.size() > 20000 ? 5 : 15;
  std::vector<Kernel::Point_3> cgal_points;
  for (const Point& p : points) cgal_points.emplace_back(p.x(), p.y(), p.z());
  InsertionReport report;
  VoronoiDiagram diagram;
  const double bytes = peak_bytes([&] { highest_first_voronoi(points); });
  double ours = 1e300, cgal = 1e300;
  for (int i = 0; i < runs; ++i) {  // alternating, so that both meet the same machine
    ours = std::min(ours, seconds([&] { diagram = highest_first_voronoi(points, {}, &report); }));
    cgal = std::min(cgal, seconds([&] { Delaunay(cgal_points.begin(), cgal_points.end()); }));
  }
  const auto n = static_cast<double>(points.size());
  const VoronoiInaccuracy quality = points.size() <= 10000 ? inaccuracy(diagram) : VoronoiInaccuracy{};
  std::printf("%-22s %8zu %9.4f %9.4f %6.2f %8.0f %6.2f %7.2f %7.2f %8.4f %7zu %9.1e %6.0f\n", name, points.size(),
              ours, cgal, cgal / ours, n / ours / 1000, static_cast<double>(diagram.vertices.size()) / n,
              100 * static_cast<double>(report.certified_insertions) / n,
              100 * static_cast<double>(report.settled_insertions) / n,
              100 * static_cast<double>(report.constrained_insertions) / n,
              static_cast<std::size_t>(report.coplanar_centers), quality.mean, bytes / n);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t largest = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 500000;
  const char* part = argc > 2 ? argv[2] : "";
  std::printf("%-22s %8s %9s %9s %6s %8s %6s %7s %7s %8s %7s %9s %6s\n", "set", "points", "orchard s", "CGAL s",
              "ratio", "kpt/s", "vert/p", "certain", "settled", "constr.", "coplan.", "inacc.", "B/pt");
  const auto set = [&](const char* name, std::size_t n, const std::function<test::Points()>& make) {
    if (n <= largest && std::strstr(name, part) != nullptr) compare(name, make());
  };
  for (const std::size_t n : {5000u, 50000u, 500000u}) {
    set("bumpy sphere", n, [&] { return test::bumpy_sphere_points(n, 1); });
    set("torus", n, [&] { return test::torus_points(n, 1); });
    set("uniform", n, [&] { return test::uniform_points(n, 1); });
    set("relaxed box", n, [&] { return test::relaxed_box_points(n, 1); });
    set("relaxed turned box", n, [&] { return test::relaxed_polyhedron_points(n, 1); });
    set("random box", n, [&] { return test::box_face_points(n, 1); });
  }
  for (const std::size_t n : {5000u, 50000u}) {
    set("sphere", n, [&] { return test::sphere_points(n, 1); });
    set("cone rings", n, [&] { return test::cone_ring_points(static_cast<int>(n) / 100, 100); });
    set("turned cone rings", n,
        [&] { return test::turned(test::cone_ring_points(static_cast<int>(n) / 100, 100), 1); });
  }
  for (const int k : {20, 40}) {
    const auto n = static_cast<std::size_t>(k * k * k);
    set("grid", n, [&] { return test::grid_points(k); });
    set("turned grid", n, [&] { return test::turned(test::grid_points(k), 1); });
    set("body-centred", 2 * n, [&] { return test::body_centered_points(k); });
    const int side = k == 20 ? 28 : 90;
    set("box lattice", static_cast<std::size_t>(6 * side * side), [&] { return test::box_lattice_points(side); });
    set("turned box lattice", static_cast<std::size_t>(6 * side * side),
        [&] { return test::turned(test::box_lattice_points(side), 1); });
  }
}
