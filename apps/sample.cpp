#include <fmt/core.h>

#include <algorithm>
#include <numbers>

#include "commands.h"
#include "console.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/sampling.h"
#include "output_folder.h"
#include "xyz.h"

#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/vtk_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

json to_json(const Evenness& evenness) {
  return {{"mean_distance", evenness.mean},
          {"least_over_mean", evenness.least},
          {"deviation_over_mean", evenness.variation}};
}

const char* name(Relaxation relaxation) { return relaxation == Relaxation::clusters ? "clusters" : "neighbors"; }

void print(const SampleCommand& command, const json& report) {
  fmt::print("{}: {} points, {} of them on edges; relaxed {} times ({})\n", command.mesh.string(),
             report["points"].get<std::size_t>(), report["edge_points"].get<std::size_t>(), command.iterations,
             report["relaxation"].get<std::string>());
  fmt::print("distance to the nearest point     mean  least / mean  deviation / mean\n");
  for (const char* when : {"before", "after"}) {
    const json& evenness = report["evenness"][when];
    fmt::print("{:26} {:11.6g} {:13.3f} {:17.3f}\n", std::string(when) + " relaxation",
               evenness["mean_distance"].get<double>(), evenness["least_over_mean"].get<double>(),
               evenness["deviation_over_mean"].get<double>());
  }
}

}  // namespace

SamplingOptions sampling_options(const SampleCommand& command, const Surface& surface) {
  constexpr double kRadians = std::numbers::pi / 180;
  SamplingOptions options{.iterations = command.iterations,
                          .seed = command.seed,
                          .relaxation = command.relaxation,
                          .crease_angle = command.crease_degrees * kRadians};
  options.edge_points = std::min(command.edge_samples.value_or(command.samples / 5), command.samples);
  options.face_points = command.samples - options.edge_points;
  if (command.cluster_degrees) options.cluster_angle = *command.cluster_degrees * kRadians;
  if (options.relaxation == Relaxation::automatic) options.relaxation = choose_relaxation(surface, options);
  return options;
}

void sample(const SampleCommand& command) {
  const bool talk = !command.output.quiet && !command.output.json;
  RepairedMesh read = read_repaired(command.mesh);
  if (talk) print_repair(command.mesh, read.repair);
  const Surface surface(std::move(read.mesh));
  SamplingOptions options = sampling_options(command, surface);

  ProgressBar bar(talk);
  const Stopwatch watch;
  const SurfaceSampling sampling = sample_surface(surface, options, bar.callback());
  const double seconds = watch.seconds();
  options.iterations = 0;
  const SurfaceSampling unrelaxed = sample_surface(surface, options, bar.callback());
  bar.clear();

  make_folder(command.folder);
  const std::filesystem::path xyz = in_folder(command.folder, command.mesh, ".xyz");
  write_file(xyz, to_xyz(sampling.points));
#ifdef ORCHARD_HAS_VIZ
  if (command.views) {
    write_points(command.folder / "points.vtp", sampling);
    write_mesh(command.folder / "mesh.vtp", surface);
  }
#endif
  const auto edge_points = std::count(sampling.origins.begin(), sampling.origins.end(), PointOrigin::edge);
  json report{{"points", sampling.size()},
              {"edge_points", edge_points},
              {"relaxation", name(options.relaxation)},
              {"iterations", command.iterations},
              {"seed", command.seed},
              {"evenness",
               {{"before", to_json(evenness(unrelaxed, surface))}, {"after", to_json(evenness(sampling, surface))}}},
              {"repair", to_json(read.repair)},
              {"seconds", seconds}};
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (!talk) return;
  print(command, report);
  fmt::print("{:.2f} s\n  {}  (a point a line)\n", seconds, xyz.string());
#ifdef ORCHARD_HAS_VIZ
  if (command.views) fmt::print("  {}  (open this in ParaView)\n", (command.folder / "points.vtp").string());
#endif
}

}  // namespace orchard::apps
