#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/reading_report.h"
#include "input/standard_input.h"
#include "input/xyz.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/sampling.h"
#include "output/outputs.h"
#include "report/report_page.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

json json_of(const Evenness& evenness) {
  return {
      {"mean_distance", evenness.mean}, {"min_over_mean", evenness.min}, {"deviation_over_mean", evenness.variation}};
}

const char* relaxation_name(Relaxation relaxation) {
  return relaxation == Relaxation::clusters ? "clusters" : "neighbors";
}

void print_sample(const SampleCommand& command, const std::string& unit, const json& report) {
  fmt::print("{}: {} points, {} of them on edges; relaxed {} times ({})\n", shown(command.mesh),
             report["points"].get<std::size_t>(), report["edge_points"].get<std::size_t>(), command.iterations,
             report["relaxation"].get<std::string>());
  fmt::print("distance to the nearest point     mean  least / mean  deviation / mean{}\n",
             unit.empty() ? "" : "   (lengths in " + unit + ")");
  for (const char* when : {"before", "after"}) {
    const json& evenness = report["evenness"][when];
    fmt::print("{:26} {:11.6g} {:13.3f} {:17.3f}\n", std::string(when) + " relaxation",
               evenness["mean_distance"].get<double>(), evenness["min_over_mean"].get<double>(),
               evenness["deviation_over_mean"].get<double>());
  }
}

}  // namespace

void check_sampling(const SampleCommand& command) {
  if (command.edge_samples.value_or(0) > command.samples) throw InputError("--edge-samples: more than --samples");
  if (!command.crease_degrees) return;
  if (command.relaxation == Relaxation::clusters)
    throw InputError("--crease-angle has no effect with --relaxation clusters");
  if (command.edge_samples == Index{0}) throw InputError("--crease-angle has no effect with --edge-samples 0");
}

SamplingOptions sampling_options(const SampleCommand& command, const Surface& surface) {
  constexpr double kRadians = std::numbers::pi / 180;
  SamplingOptions options{.iterations = command.iterations, .seed = command.seed, .relaxation = command.relaxation};
  options.edge_points = command.edge_samples.value_or(command.samples / 5);
  options.face_points = command.samples - options.edge_points;
  if (command.cluster_degrees) options.cluster_angle = *command.cluster_degrees * kRadians;
  if (command.crease_degrees) options.crease_angle = *command.crease_degrees * kRadians;
  if (options.relaxation == Relaxation::automatic) options.relaxation = choose_relaxation(surface, options);
  return options;
}

void sample(const SampleCommand& command) {
  const std::string xyz = named(command.mesh, ".xyz"), points = named(command.mesh, "-sample-points.vtp"),
                    mesh = named(command.mesh, "-sample-mesh.vtp"), page = page_name(command.mesh, "sample");
  check_input(command.mesh);
  check_sampling(command);
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, "-sample.json"),
                          .provenance = provenance_of(command.output.run, std::array{command.mesh}),
                          .force = command.output.force};
  keep_single_file(destination, std::array{xyz, points});
  check_outputs(destination, std::array{xyz, points, mesh, page}, std::array{command.mesh});
  const bool talk = !command.output.quiet && !command.output.json;
  RepairedMesh read = read_repaired(command.mesh, command.input, command.join);
  const Surface surface(std::move(read.mesh));
  if (talk) {
    print_reading(command.mesh, read.reading);
    print_repair(command.mesh, read.repair, read.distance, surface.bounding_radius());
  }
  print_hole_warning(command.mesh, read.repair, read.distance, surface.bounding_radius());
  SamplingOptions options = sampling_options(command, surface);

  ProgressBar bar(talk);
  const Stopwatch watch;
  const SurfaceSampling sampling = sample_surface(surface, options, bar.callback());
  const double seconds = watch.seconds();
  options.iterations = 0;
  const SurfaceSampling unrelaxed = sample_surface(surface, options, bar.callback());
  bar.clear();

  json evenness_json{{"before", json_of(evenness(unrelaxed, surface))},
                     {"after", json_of(evenness(sampling, surface))}};

  Outputs outputs(destination);
  write_file(outputs.add(xyz, "a point a line"), to_xyz(sampling.points));
#ifdef ORCHARD_HAS_VIZ
  if (command.views) {
    write_points(outputs.add(points, "open this in ParaView"), sampling);
    write_mesh(outputs.add(mesh), surface);
  }
#endif
  const auto edge_points = std::count(sampling.origins.begin(), sampling.origins.end(), PointOrigin::edge);
  json report{{"points", sampling.size()},
              {"edge_points", edge_points},
              {"relaxation", relaxation_name(options.relaxation)},
              {"iterations", command.iterations},
              {"seed", command.seed},
              {"evenness", std::move(evenness_json)},
              {"reading", reading_json(read.reading)},
              {"repair", to_json(read.repair, read.distance, surface.bounding_radius())},
              {"seconds", seconds}};
  outputs.add_report(report, "this report as JSON");
  if (command.report) write_report_page(page, {.report = report}, outputs);
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!talk) return;
  print_sample(command, read.reading.unit, report);
  fmt::print("{:.2f} s\n", seconds);
  outputs.print();
}

}  // namespace orchard::apps
