// Seconds and memory of medial axes, the interior classification against its slow twin, and how gap repair of a thin
// plate grows with the points. orchard_medial_bench POINTS MESHES..
#include <sys/resource.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>
#include <utility>

#include "axis/interior.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/medial/build.h"
#include "orchard/medial/topology.h"
#include "orchard/voronoi/highest_first.h"
#include "support/shapes.h"

namespace {

using namespace orchard;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void classify(const Surface& surface, const SurfaceSampling& sampling) {
  const VoronoiDiagram diagram = highest_first_voronoi(sampling.points).diagram;
  double start = processor_seconds();
  const std::vector<std::uint8_t> inside = detail::interior_vertices(surface, diagram);
  const double fast = processor_seconds() - start;
  start = processor_seconds();
  std::size_t differ = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const VoronoiVertex& vertex = diagram.vertices[i];
    const bool slow = !vertex.at_infinity() && vertex.center.allFinite() && surface.inside(vertex.center);
    differ += slow != (inside[i] != 0) ? 1 : 0;
  }
  const double slow = processor_seconds() - start;
  std::printf("  classification: %zu vertices in %.2f s, one by one %.2f s: %.1f times as fast; %zu differ\n",
              inside.size(), fast, slow, slow / fast, differ);
}

void run(const std::string& file, Index points) {
  TriangleMesh mesh = read_mesh(file);
  repair_mesh(mesh);
  const Surface surface(std::move(mesh));
  MedialBuildOptions options;
  options.sampling.face_points = points - points / 5;
  options.sampling.edge_points = points / 5;
  const MedialBuild build = build_medial_axis(surface, options);
  std::printf("%s: %zu triangles, %u + %u points, %u medial vertices, topology %s\n",
              std::filesystem::path(file).stem().c_str(), surface.mesh().triangles.size(), build.points,
              build.gap_repair.points_added, build.axis.size(),
              topology(medial_mesh(build.axis)) == solid_topology(surface) ? "right" : "wrong");
  double whole = 0;
  for (const auto& [stage, seconds] : build.seconds) {
    std::printf("  %s %.2f s;", stage.c_str(), seconds);
    whole += seconds;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(" in all %.2f s; peak %.0f MB\n", whole, static_cast<double>(usage.ru_maxrss) / 1024);
  classify(surface, build.sampling);
}

// Nearly every cell of a plate thinner than its points are apart needs a new point: the worst for what compares them.
void repair_plate(Index points) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1e-3}));
  SurfaceSampling sampling = sample_surface(surface, {.face_points = points - points / 5, .edge_points = points / 5});
  VoronoiDiagram diagram = highest_first_voronoi(sampling.points).diagram;
  const double start = processor_seconds();
  const GapRepair repaired = repair_gap_crossings(surface, std::move(sampling), std::move(diagram));
  const double seconds = processor_seconds() - start;
  std::size_t steps = 0;
  for (const GapRepairPass& pass : repaired.report.passes) steps += pass.steps_among_new_points;
  std::printf("  thin plate, %u points: gap repair %.2f s, %u added, %.0f steps among new points for each\n", points,
              seconds, repaired.report.points_added, static_cast<double>(steps) / repaired.report.points_added);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: orchard_medial_bench POINTS MESHES..\n");
    return 2;
  }
  for (int i = 2; i < argc; ++i) run(argv[i], static_cast<Index>(std::stoul(argv[1])));
  for (const Index points : {10000u, 20000u, 40000u, 80000u}) repair_plate(points);
}
