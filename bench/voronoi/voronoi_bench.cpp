// Highest-first against CGAL's sequential Delaunay triangulation on the same points in the same run: seconds of
// processor time (the best of several), their ratio, growth from the set of a tenth of the size, how the insertions
// were decided, the certificate's part of the time, the inaccuracy, and bytes a point at the peak. Then the moment
// curve beside CGAL with places for its Voronoi vertices, insertion into a diagram, and the metric on 100,000 points.
// All by one thread. voronoi_bench [largest number of points] [part of a set's name, or insert_points, or sets: all of
// them and nothing else, or growth: two sets alone, of 50,000 to 5,000,000 points] [folder of the models]
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <string>

#include "algorithms/build.h"
#include "certificate/certificate.h"
#include "hard_sets.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/quality.h"
#include "peak_memory.h"
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

double wall_seconds(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Of the look at a finished diagram, once the error bounds of its vertices are known, as they are after insertion.
double certificate_seconds(const VoronoiDiagram& diagram, bool exact) {
  const Box box = detail::checked_box(diagram.points);
  const detail::Frame frame(box);
  detail::Workspace workspace;
  detail::set_scale(workspace, frame, box);
  for (const Point& p : diagram.points) workspace.points.push_back(frame.inward(p));
  workspace.adopt(diagram.vertices, frame, 0);
  workspace.set_exact(exact);
  if (exact) workspace.forget_noise();
  const std::size_t forming = detail::count_forming(workspace);
  double best = 1e300;
  for (int i = 0; i < 4; ++i) best = std::min(best, seconds([&] { detail::certify(workspace, forming); }));
  return best;
}

class Table {
 public:
  Table() {
    std::printf("%-20s %7s %9s %9s %6s %6s %6s  %6s %7s %6s %6s %5s %6s  %8s %6s %6s\n", "set", "points", "orchard s",
                "CGAL s", "ratio", "kpt/s", "growth", "certif", "settled", "exact", "constr", "again", "look %",
                "inacc/R", "vert/p", "B/pt");
  }

  void add(const std::string& name, const test::Points& points) {
    const bool huge = points.size() > 1000000;
    const int runs = huge ? 1 : points.size() > 200000 ? 2 : points.size() > 20000 ? 5 : 15;
    std::vector<Kernel::Point_3> cgal_points;
    for (const Point& p : points) cgal_points.emplace_back(p.x(), p.y(), p.z());
    const double bytes = bench::peak_bytes([&] { highest_first_voronoi(points); }, !huge);
    VoronoiBuild build;
    double ours = 1e300, cgal = 1e300;
    for (int i = 0; i < runs; ++i) {  // alternating, so that both meet the same machine
      ours = std::min(ours, seconds([&] { build = highest_first_voronoi(points); }));
      cgal = std::min(cgal, seconds([&] { Delaunay(cgal_points.begin(), cgal_points.end()); }));
    }
    print(name, points, build.diagram, build.report, ours, cgal, bytes);
  }

 private:
  void print(const std::string& name, const test::Points& points, const VoronoiDiagram& diagram,
             const InsertionReport& report, double ours, double cgal, double bytes) {
    const auto n = static_cast<double>(points.size());
    const double inaccurate = n > 200000 ? std::nan("") : inaccuracy(diagram).mean;  // takes longer than the diagram
    const auto percent = [n](std::uint64_t count) { return 100 * static_cast<double>(count) / n; };
    Box box;
    for (const Point& p : points) box.extend(p);
    std::printf("%-20s %7zu %9.4f %9.4f %6.2f %6.0f %6s  %6.2f %7.2f %6.2f %6.3f %5s %6.1f  %8.1e %6.2f %6.0f\n",
                name.c_str(), points.size(), ours, cgal, cgal / ours, n / ours / 1000, growth(name, n, ours).c_str(),
                percent(report.certified_insertions), percent(report.settled_insertions),
                percent(report.exact_insertions), percent(report.constrained_insertions),
                report.exact_signs ? "yes" : "no",
                n > 1000000 ? std::nan("") : 100 * certificate_seconds(diagram, report.exact_signs) / ours,
                2 * inaccurate / box.diagonal().norm(), static_cast<double>(diagram.vertices.size()) / n, bytes / n);
    std::fflush(stdout);
  }

  // The time over that of the last set of this name, in terms of n log n: 1 if it grows like that.
  std::string growth(const std::string& name, double n, double time) {
    const auto last = last_.find(name);
    char text[16] = "-";
    if (last != last_.end()) {
      const auto [m, before] = last->second;
      std::snprintf(text, sizeof text, "%.2f", time / before / (n * std::log(n) / (m * std::log(m))));
    }
    last_[name] = {n, time};
    return text;
  }

  std::map<std::string, std::pair<double, double>> last_;
};

// Where nearly half of the vertices are so thin that their places are most of the work, which CGAL's triangulation, the
// table's rival, does without: the same beside CGAL with a place, too, for each: as its circumcenter() in doubles gives
// it, of any quality.
void with_voronoi_vertices(const char* name, const test::Points& points) {
  std::vector<Kernel::Point_3> cgal_points;
  for (const Point& p : points) cgal_points.emplace_back(p.x(), p.y(), p.z());
  double ours = 1e300, bare = 1e300, placed = 1e300;
  for (int i = 0; i < 15; ++i) {
    ours = std::min(ours, seconds([&] { highest_first_voronoi(points); }));
    bare = std::min(bare, seconds([&] { Delaunay(cgal_points.begin(), cgal_points.end()); }));
    placed = std::min(placed, seconds([&] {
                        const Delaunay triangulation(cgal_points.begin(), cgal_points.end());
                        std::vector<Kernel::Point_3> vertices;
                        vertices.reserve(triangulation.number_of_finite_cells());
                        for (const auto cell : triangulation.finite_cell_handles())
                          vertices.push_back(triangulation.dual(cell));
                      }));
  }
  std::printf(
      "%-20s %7zu points: orchard %.4f s, CGAL's triangulation %.4f s, "
      "with the circumcentre of each finite cell %.4f s, ratio to that %.2f\n",
      name, points.size(), ours, bare, placed, placed / ours);
  std::fflush(stdout);
}

test::Points model_points(const std::string& file, std::size_t n) {
  const auto all = static_cast<Index>(n), edge = all / 5;
  return sample_surface(Surface(read_mesh(file)), {.face_points = all - edge, .edge_points = edge}).points;
}

void insertion(const char* name, const test::Points& points, std::size_t last) {
  const VoronoiDiagram before = highest_first_voronoi(std::span(points).first(points.size() - last)).diagram;
  double best = 1e300, best_wall = 1e300;
  for (int i = 0; i < 9; ++i) {
    VoronoiDiagram diagram = before;
    double cpu = 0;
    const double wall = wall_seconds(
        [&] { cpu = seconds([&] { insert_points(diagram, std::span(points).subspan(points.size() - last)); }); });
    best = std::min(best, cpu);
    best_wall = std::min(best_wall, wall);
  }
  const double whole = seconds([&] { highest_first_voronoi(points); });
  std::printf(
      "%-20s %7zu + %4zu points: %5.1f ms of processor time, %5.1f ms; all from scratch: %5.1f ms, %4.1f times as "
      "long\n",
      name, points.size() - last, last, 1e3 * best, 1e3 * best_wall, 1e3 * whole, whole / best);
}

void metric(const char* name, const test::Points& points) {
  const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  VoronoiInaccuracy result;
  const double time = seconds([&] { result = inaccuracies(diagram).segments; });
  std::printf("%-20s %7zu points: %.2f s of processor time, %llu samples, mean %.1e\n", name, points.size(), time,
              static_cast<unsigned long long>(result.samples), result.mean);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t max = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 500000;
  const char* part = argc > 2 ? argv[2] : "";
  const std::string data = argc > 3 ? argv[3] : "data";
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  Table table;
  if (std::string(part) == "growth") {
    for (const std::size_t n : {50000u, 500000u, 5000000u}) {
      if (n > max) continue;
      table.add("uniform", test::uniform_points(n, 1));
      table.add("bumpy sphere", test::bumpy_sphere_points(n, 1));
    }
    return 0;
  }
  const bool only_sets = std::string(part) == "sets";
  if (only_sets) part = "";
  const auto set = [&](const std::string& name, std::size_t n, const std::function<test::Points()>& make) {
    if (n <= max && name.find(part) != std::string::npos) table.add(name, make());
  };
  for (const std::size_t n : {5000u, 50000u, 500000u}) {
    set("bumpy sphere", n, [&] { return test::bumpy_sphere_points(n, 1); });
    set("uniform", n, [&] { return test::uniform_points(n, 1); });
    set("relaxed turned box", n, [&] { return test::relaxed_polyhedron_points(n, 1); });
    set("faucet", n, [&] { return model_points(data + "/faucet.obj", n); });
  }
  for (const std::size_t n : {5000u, 50000u}) {
    for (const char* model : {"lamp", "ship"})
      set(model, n, [&] { return model_points(data + "/" + model + ".obj", n); });
    set("relaxed box", n, [&] { return test::relaxed_box_points(n, 1); });
    set("random torus", n, [&] { return test::torus_points(n, 1); });
    set("sphere", n, [&] { return test::sphere_points(n, 1); });
    set("cone rings", n, [&] { return test::cone_ring_points(static_cast<int>(n) / 100, 100); });
    set("turned cone rings", n,
        [&] { return test::turned(test::cone_ring_points(static_cast<int>(n) / 100, 100), 1); });
  }
  for (const std::size_t n : {100000u, 400000u})  // whose flat faces are dense
    for (const char* model : {"lamp", "ship"})
      set(model, n, [&] { return model_points(data + "/" + model + ".obj", n); });
  for (const int k : {20, 40}) {
    const auto n = static_cast<std::size_t>(k * k * k);
    set("grid", n, [&] { return test::grid_points(k); });
    set("turned grid", n, [&] { return test::turned(test::grid_points(k), 1); });
    set("body-centred", 2 * n, [&] { return test::body_centered_points(k); });
    const int side = k == 20 ? 28 : 90;
    set("box lattice", static_cast<std::size_t>(6 * side * side), [&] { return test::box_lattice_points(side); });
    set("turned box lattice", static_cast<std::size_t>(6 * side * side),
        [&] { return test::turned(test::box_lattice_points(side), 1); });
    set("integer grid", n, [&] { return bench::integer_grid_points(k); });
  }
  for (const std::size_t n : {5000u, 50000u, 500000u}) set("clusters", n, [&] { return bench::cluster_points(n, 1); });
  for (const int rings : {20, 50, 140})
    set("cylinder rings", static_cast<std::size_t>(360 * rings),
        [&] { return bench::cylinder_ring_points(rings, 360); });
  for (const int across : {40, 125})
    set("torus lattice", static_cast<std::size_t>(3 * across * across),
        [&] { return bench::torus_lattice_points(3 * across, across); });
  for (const std::size_t n : {5000u, 50000u}) set("noisy lines", n, [&] { return bench::noisy_line_points(n, 1); });
  for (const std::size_t n : {500u, 1500u}) {
    set("moment curve", n, [&] { return bench::moment_curve_points(n); });
    set("skew lines", n, [&] { return bench::skew_line_points(n, 1); });
  }
  if (only_sets) return 0;
  const auto holds_part = [&](const char* name) { return std::string(name).find(part) != std::string::npos; };
  if (holds_part("moment curve")) {
    std::printf("\nBeside CGAL with its Voronoi vertices\n");
    for (const std::size_t n : {500u, 1500u}) with_voronoi_vertices("moment curve", bench::moment_curve_points(n));
  }
  if (*part != '\0' && std::string(part) != "insert_points") return 0;
  std::printf("\ninsert_points\n");
  insertion("bumpy sphere", test::bumpy_sphere_points(51000, 1), 1000);
  insertion("uniform", test::uniform_points(51000, 1), 1000);
  insertion("relaxed turned box", test::relaxed_polyhedron_points(51000, 1), 1000);
  insertion("faucet", model_points(data + "/faucet.obj", 51000), 1000);
  if (*part != '\0') return 0;
  std::printf("\ninaccuracy\n");
  metric("bumpy sphere", test::bumpy_sphere_points(100000, 1));
  metric("faucet", model_points(data + "/faucet.obj", 100000));
}
