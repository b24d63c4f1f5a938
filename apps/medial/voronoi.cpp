#include "orchard/voronoi/algorithms.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/reading_report.h"
#include "input/xyz.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/voronoi/diagram_io.h"
#include "orchard/voronoi/quality.h"
#include "output/outputs.h"
#include "report/report_page.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/voronoi_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

struct Input {
  std::vector<Point> points;
  MeshReadReport reading;
  // Of a mesh, whose surface the points are on.
  std::optional<MeshRepairReport> repair;
  RepairDistance distance;
  double bounding_radius = 0;
};

Input read_input(const VoronoiCommand& command, const Progress& progress) {
  Input input;
  auto [mesh, reading] = read_input_or_points(command.input, command.sampling.input);
  input.reading = std::move(reading);
  if (mesh.triangles.empty()) {
    for (const std::string& option : command.sampling_given)
      if (option != "seed")
        throw InputError(fmt::format("--{} has no effect on {}, which has no faces; it is for sampling a mesh", option,
                                     command.input.string()));
    input.points = std::move(mesh.vertices);
    return input;
  }
  RepairedMesh read = read_repaired(command.input, command.sampling.input, command.sampling.join);
  const Surface surface(std::move(read.mesh));
  input.points = sample_surface(surface, sampling_options(command.sampling, surface), progress).points;
  input.repair = std::move(read.repair);
  input.distance = read.distance;
  input.bounding_radius = surface.bounding_radius();
  return input;
}

// One algorithm's diagram of the points, and what the table says about it.
struct AlgorithmRun {
  VoronoiAlgorithm algorithm = VoronoiAlgorithm::highest_first;
  std::string failure = {};  // not empty: the algorithm gave up, and there is no more than this
  double seconds = 0;
  VoronoiDiagram diagram = {};
  InsertionReport report = {};
  VoronoiInaccuracy inaccuracy = {}, corners = {};

  std::size_t vertices_at_infinity() const {
    return static_cast<std::size_t>(std::count_if(diagram.vertices.begin(), diagram.vertices.end(),
                                                  [](const VoronoiVertex& v) { return v.at_infinity(); }));
  }
};

AlgorithmRun run(const std::vector<Point>& points, VoronoiAlgorithm algorithm, const Progress& progress) {
  AlgorithmRun result{.algorithm = algorithm};
  const Stopwatch watch;
  VoronoiBuild build = orchard::voronoi(points, algorithm, progress);
  result.seconds = watch.seconds();
  result.diagram = std::move(build.diagram);
  result.report = std::move(build.report);
  validate(result.diagram);
  const auto [segments, corners] = inaccuracies(result.diagram, progress);
  result.inaccuracy = segments;
  result.corners = corners;
  return result;
}

// Bowyer's algorithm may fail; a comparison says so and goes on.
AlgorithmRun run_to_compare(const std::vector<Point>& points, VoronoiAlgorithm algorithm, const Progress& progress) {
  const Stopwatch watch;
  try {
    return run(points, algorithm, progress);
  } catch (const InputError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    return {.algorithm = algorithm, .failure = error.what(), .seconds = watch.seconds()};
  }
}

std::vector<AlgorithmRun> run_all(const VoronoiCommand& command, const std::vector<Point>& points,
                                  const Progress& progress) {
  std::vector<AlgorithmRun> runs;
  try {
    if (!command.compare)
      runs.push_back(run(points, command.algorithm, progress));
    else
      for (const VoronoiAlgorithm algorithm : kVoronoiAlgorithms)
        runs.push_back(run_to_compare(points, algorithm, progress));
  } catch (const InputError& error) {
    throw InputError(command.input.string() + ": " + error.what());
  }
  return runs;
}

json inaccuracy_json(const VoronoiInaccuracy& inaccuracy) {
  return {{"mean", inaccuracy.mean}, {"max", inaccuracy.max}, {"samples", inaccuracy.samples}};
}

json run_json(const AlgorithmRun& run) {
  json result{{"algorithm", name(run.algorithm)}, {"failures", run.failure.empty() ? 0 : 1}, {"seconds", run.seconds}};
  if (!run.failure.empty()) {
    result["failure"] = run.failure;
    return result;
  }
  const InsertionReport& report = run.report;
  result.update({{"dimension", report.dimension},
                 {"vertices", run.diagram.vertices.size()},
                 {"vertices_at_infinity", run.vertices_at_infinity()},
                 {"inaccuracy", inaccuracy_json(run.inaccuracy)},
                 {"corner_inaccuracy", inaccuracy_json(run.corners)},
                 {"duplicates", report.duplicates},
                 {"bytes_per_point", static_cast<double>(run.diagram.vertices.size() * sizeof(VoronoiVertex)) /
                                             static_cast<double>(run.diagram.points.size()) +
                                         sizeof(Point)}});
  if (run.algorithm != VoronoiAlgorithm::exact)
    result["insertions"] = {{"certified", report.certified_insertions}, {"settled", report.settled_insertions},
                            {"exact", report.exact_insertions},         {"constrained", report.constrained_insertions},
                            {"exact_signs", report.exact_signs},        {"coplanar_centers", report.coplanar_centers}};
  if (run.algorithm == VoronoiAlgorithm::highest_first)
    result["certified_intrusion_over_radius"] = report.certified_intrusion;
  return result;
}

void print_table(const std::vector<AlgorithmRun>& runs) {
  fmt::print(
      "algorithm      vertices  infinite  coplanar  inaccuracy mean         max  at corners  failures  seconds\n");
  for (const AlgorithmRun& run : runs) {
    fmt::print("{:<13}", name(run.algorithm));
    if (run.failure.empty())
      fmt::print("{:10} {:9} {:9} {:16.3g} {:11.3g} {:11.3g}", run.diagram.vertices.size(), run.vertices_at_infinity(),
                 run.report.coplanar_centers, run.inaccuracy.mean, run.inaccuracy.max, run.corners.mean);
    else
      fmt::print("{:>10} {:>9} {:>9} {:>16} {:>11} {:>11}", "-", "-", "-", "-", "-", "-");
    fmt::print("  {:8} {:8.3f}\n", run.failure.empty() ? 0 : 1, run.seconds);
  }
  for (const AlgorithmRun& run : runs)
    if (!run.failure.empty()) fmt::print("{}\n", run.failure);
}

void print_insertions(const AlgorithmRun& run) {
  const InsertionReport& report = run.report;
  if (run.algorithm != VoronoiAlgorithm::highest_first || run.diagram.vertices.empty()) return;
  fmt::print("highest-first insertions: {} certified, {} settled, {} by exact signs, {} by the constrained search{}\n",
             report.certified_insertions, report.settled_insertions, report.exact_insertions,
             report.constrained_insertions, report.exact_signs ? "; all with exact signs in the end" : "");
  fmt::print(
      "certified: no point is deeper than {:.2g} of the bounding radius in a sphere, or farther beyond the hull\n",
      report.certified_intrusion);
  if (!report.duplicates.empty())
    fmt::print("{} points coincide with an earlier one and were left out\n", report.duplicates.size());
}

void print_diagrams(const VoronoiCommand& command, const Input& input, const std::vector<AlgorithmRun>& runs) {
  Box box;
  for (const Point& p : input.points) box.extend(p);
  fmt::print("{}: {} points{}, {:.4g} x {:.4g} x {:.4g}\n", command.input.string(), input.points.size(),
             input.repair ? " sampled" : "", box.sizes().x(), box.sizes().y(), box.sizes().z());
  print_table(runs);
  for (const AlgorithmRun& run : runs) print_insertions(run);
  if (runs.back().failure.empty() && runs.back().report.dimension < 3)
    fmt::print("The points {}, so they have no Voronoi vertices.\n",
               std::array{"are one", "lie on a line",
                          "lie in a plane"}[static_cast<std::size_t>(std::max(runs.back().report.dimension, 0))]);
}

std::string points_name(const VoronoiCommand& command) { return named(command.input, "-voronoi.xyz"); }

std::string diagram_name(const VoronoiCommand& command, VoronoiAlgorithm algorithm, const char* extension) {
  return named(command.input, fmt::format("-{}{}", name(algorithm), extension));
}

void write_diagrams(const VoronoiCommand& command, const Input& input, const std::vector<AlgorithmRun>& runs,
                    Outputs& outputs) {
  if (input.repair) write_file(outputs.add(points_name(command), "a point a line"), to_xyz(input.points));
  for (const AlgorithmRun& run : runs) {
    if (!run.failure.empty()) continue;
    write_file(outputs.add(diagram_name(command, run.algorithm, ".vor"), "the diagram as text"), to_vor(run.diagram));
  }
#ifdef ORCHARD_HAS_VIZ
  VoronoiCellsView view;
  if (!command.cells.empty()) view.points = command.cells;
  if (!command.box.empty()) view.box = Box(Point(command.box.data()), Point(command.box.data() + 3));
  for (const AlgorithmRun& run : runs) {
    if (!run.failure.empty()) continue;
    write_voronoi_cells(outputs.add(diagram_name(command, run.algorithm, ".vtu"), "open this in ParaView"), run.diagram,
                        view);
  }
#endif
}

// What can be refused before anything is built; then where the files go, if anywhere.
Destination check(const VoronoiCommand& command) {
#ifndef ORCHARD_HAS_VIZ
  if (!command.cells.empty() || !command.box.empty())
    throw InputError("--cells and --box have no effect: this program was built without VTK, which writes the cells");
#endif
  if (!command.box.empty() && !(Box(Point(command.box.data()), Point(command.box.data() + 3)).volume() > 0))
    throw InputError("--box needs x y z of its lower corner, then of its upper one, with room between them");
  check_input(command.input);
  check_sampling(command.sampling);
  Destination destination{.folder = command.folder,
                          .report = named(command.input, "-voronoi.json"),
                          .provenance = provenance_of(command.output.run, std::array{command.input}),
                          .force = command.output.force};
  if (command.folder.empty()) return destination;
  std::vector<std::string> names{points_name(command), page_name(command.input, "voronoi")};
  for (const VoronoiAlgorithm algorithm : kVoronoiAlgorithms)
    if (command.compare || algorithm == command.algorithm)
      for (const char* extension : {".vor", ".vtu"}) names.push_back(diagram_name(command, algorithm, extension));
  check_outputs(destination, names, std::array{command.input});
  return destination;
}

void check_cells(const VoronoiCommand& command, const Input& input) {
  for (const Index cell : command.cells)
    if (cell >= input.points.size())
      throw InputError(
          fmt::format("--cells {}: there are only {} points, which are counted from 0", cell, input.points.size()));
}

}  // namespace

void voronoi(const VoronoiCommand& command) {
  const Destination destination = check(command);
  const bool talk = !command.output.quiet && !command.output.json;
  ProgressBar bar(talk);
  const Input input = read_input(command, bar.callback());
  check_cells(command, input);
  const std::vector<AlgorithmRun> runs = run_all(command, input.points, bar.callback());
  bar.clear();
  if (talk) print_reading(command.input, input.reading);
  if (talk && input.repair) print_repair(command.input, *input.repair, input.distance, input.bounding_radius);
  if (input.repair) print_hole_warning(command.input, *input.repair, input.distance, input.bounding_radius);
  if (talk) print_diagrams(command, input, runs);
  json report{
      {"points", input.points.size()}, {"sampled", input.repair.has_value()}, {"reading", reading_json(input.reading)}};
  if (input.repair) report["repair"] = to_json(*input.repair, input.distance, input.bounding_radius);
  for (const AlgorithmRun& run : runs) report["algorithms"].push_back(run_json(run));
  report["provenance"] = to_json(destination.provenance);
  if (!command.folder.empty()) {
    Outputs outputs(destination);
    write_diagrams(command, input, runs, outputs);
    outputs.add_report(report, "this report as JSON");
    if (command.report) write_report_page(page_name(command.input, "voronoi"), {.report = report}, outputs);
    outputs.commit();
    if (talk) outputs.print();
  }
  if (command.output.json) fmt::print("{}\n", report.dump(2));
}

}  // namespace orchard::apps
