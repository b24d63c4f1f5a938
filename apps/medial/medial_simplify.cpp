#include "medial/medial_simplify.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/structure.h"
#include "output/json_values.h"
#include "output/stamp.h"
#include "svg_plot.h"
#ifdef ORCHARD_HAS_VIZ
#include "orchard/viz/medial_writer.h"
#endif

namespace orchard::apps {
namespace {

using nlohmann::json;

// The numbers of vertices that an error curve has.
constexpr Index kErrorCurve[] = {5000, 2000, 1000, 500, 200, 100, 50, 20, 10, 5, 2, 1};

bool simplifies(const MedialCommand& command) { return command.few_vertices > 0 || command.few_error > 0; }

std::string model_of(const MedialCommand& command) {
  return (command.axis.empty() ? command.mesh : command.axis).string();
}

// In percent of the diagonal.
json simplification_json(const SimplifyReport& report) {
  return {{"vertices", report.vertices},
          {"hausdorff_max", 100 * report.hausdorff.max},
          {"hausdorff_mean", 100 * report.hausdorff.mean},
          {"coverage_max", 100 * report.coverage.max},
          {"coverage_mean", 100 * report.coverage.mean},
          {"protrusion_max", 100 * report.protrusion.max},
          {"protrusion_mean", 100 * report.protrusion.mean},
          {"hausdorff_upper", 100 * report.upper}};
}

std::string to_csv(const std::vector<SimplifiedMedialMesh>& curve) {
  std::string text =
      "vertices,edges,triangles,hausdorff_max,hausdorff_mean,hausdorff_upper,coverage_max,protrusion_max\n";
  for (const auto& [mesh, report] : curve)
    text += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", report.vertices, mesh.edges.size(),
                        mesh.triangles.size(), 100 * report.hausdorff.max, 100 * report.hausdorff.mean,
                        100 * report.upper, 100 * report.coverage.max, 100 * report.protrusion.max);
  return text;
}

std::string to_svg(const std::vector<SimplifiedMedialMesh>& curve) {
  plot::Plot plot;
  plot.title = "Two-sided distance of surface and envelope";
  plot.x_label = "balls";
  plot.y_label = "% of the diagonal";
  plot.log_x = plot.log_y = true;
  const auto add = [&](const char* name, double Spread::*value) {
    plot::Series& series = plot.series.emplace_back();
    series.name = name;
    series.kind = plot::Series::Kind::line;
    for (const auto& [mesh, report] : curve) {
      series.x.push_back(report.vertices);
      series.y.push_back(100 * report.hausdorff.*value);
    }
  };
  add("maximum", &Spread::max);
  add("mean", &Spread::mean);
  return plot::to_svg({plot});
}

std::string lost_of(const EnvelopeMesh& envelope) {
  if (envelope.lost == 0) return {};
  return fmt::format("; what {} of the balls stand for is thinner than its cells and lost: --envelope-cell",
                     envelope.lost);
}

void print_few_balls(const FewBalls& few) {
  const auto row = [](const SimplifyReport& report) {
    fmt::print("  {:>7} {:>12.3f} {:>8.3f} {:>10.4f} {:>10.3f} {:>12.3f}\n", report.vertices,
               100 * report.hausdorff.max, 100 * report.upper, 100 * report.hausdorff.mean, 100 * report.coverage.max,
               100 * report.protrusion.max);
  };
  if (few.simplified || !few.error_curve.empty()) {
    fmt::print("in few balls: distance of surface and envelope, % of the diagonal\n");
    fmt::print("  {:>7} {:>12} {:>8} {:>10} {:>10} {:>12}\n", "balls", "two-sided", "proven", "mean", "coverage",
               "protrusion");
  }
  for (const auto& [mesh, report] : few.error_curve) row(report);
  if (few.simplified) row(few.simplified->report);
  if (few.envelope) {
    fmt::print("envelope: {} vertices, {} triangles{}\n", few.envelope->mesh.vertices.size(),
               few.envelope->mesh.triangles.size(), lost_of(*few.envelope));
  }
  for (const auto& [stage, time] : few.seconds) fmt::print("  {:<18} {:>8.2f} s\n", stage, time);
}

}  // namespace

bool given(const MedialCommand& command, const char* option) {
  return std::find(command.given.begin(), command.given.end(), option) != command.given.end();
}

SimplifyOptions few_balls_options(const MedialCommand& command) {
  return {.vertices = command.few_vertices,
          .error = command.few_error / 100,
          .balls = command.few_kind == "free" ? SimplifiedBalls::free : SimplifiedBalls::medial,
          .seed = command.tuning.options.sampling.seed};
}

std::vector<std::string> few_balls_names(const MedialCommand& command) {
  std::vector<std::string> names;
  const auto add = [&](const char* ending) { names.push_back(named(model_of(command), ending)); };
  if (simplifies(command)) {
    for (const char* ending : {"-simplified.ma", "-simplified.ply", "-simplified.obj", "-simplified.vtp"}) add(ending);
  }
  if (command.error_curve) {
    for (const char* ending : {"-error-curve.csv", "-error-curve.svg"}) add(ending);
  }
  return names;
}

void check_simplification(const MedialCommand& command) {
  if (given(command, "balls") && !simplifies(command) && !command.error_curve)
    throw InputError("--balls has no effect without --vertices, --error or --error-curve");
  if (given(command, "error") && !(command.few_error > 0)) throw InputError("--error: expected a percentage above 0");
}

void check_few_balls(const MedialCommand& command, const Destination& destination,
                     const std::vector<std::filesystem::path>& inputs) {
  if (!command.sweep.empty()) {
    for (const char* option : {"error-curve", "envelope"}) {
      if (given(command, option)) throw InputError(fmt::format("--{} has no effect with --sweep", option));
    }
    return;  // each run is checked by itself
  }
  check_simplification(command);
  if (!command.envelope.empty()) {
    if (command.envelope.extension() != ".obj")
      throw InputError("--envelope " + command.envelope.string() + ": expected a name that ends with .obj");
    // The output folder need not be there yet.
    const std::filesystem::path folder = command.envelope.parent_path();
    if (std::filesystem::weakly_canonical(folder) == std::filesystem::weakly_canonical(command.folder)) {
      const std::vector<std::string> names{command.envelope.filename().string()};
      check_outputs(destination, names, inputs);
    } else {
      check_output(command.envelope, inputs);
    }
  }
}

FewBalls make_few_balls(const MedialCommand& command, const Surface& surface, const MedialMesh& axis,
                        const Progress& progress) {
  FewBalls few;
  if (command.error_curve) {
    std::vector<Index> counts;
    std::copy_if(std::begin(kErrorCurve), std::end(kErrorCurve), std::back_inserter(counts),
                 [&](Index count) { return count <= axis.size(); });
    time_stage(few.seconds, "error_curve", [&] {
      few.error_curve = simplify_to_each(surface, axis, counts, few_balls_options(command), progress);
    });
  }
  if (simplifies(command)) {
    time_stage(few.seconds, "simplifying",
               [&] { few.simplified = simplify_medial_mesh(surface, axis, few_balls_options(command), progress); });
  }
  if (!command.envelope.empty()) {
    const EnvelopeOptions options{.cell = command.envelope_cell / 100};
    time_stage(few.seconds, "envelope",
               [&] { few.envelope = envelope_mesh(few.simplified ? few.simplified->mesh : axis, options, progress); });
  }
  return few;
}

void write_few_balls(const MedialCommand& command, const Provenance& provenance, const FewBalls& few, json& report,
                     Outputs& outputs) {
  const auto name = [&](const char* ending) { return named(model_of(command), ending); };
  if (few.simplified) {
    const MedialMesh& mesh = few.simplified->mesh;
    report["simplified"] = simplification_json(few.simplified->report);
    report["simplified"]["edges"] = mesh.edges.size();
    report["simplified"]["triangles"] = mesh.triangles.size();
    write_file(outputs.add(name("-simplified.ma"), "the axis in few balls, edges flagged by their features"),
               to_ma(with_feature_flags(mesh)) + to_structure_section(medial_structure(mesh)));
    write_file(outputs.add(name("-simplified.ply"), "the same with edges and radii"), to_ply(mesh));
    write_file(outputs.add(name("-simplified.obj"), "its sheets"), to_obj(mesh));
#ifdef ORCHARD_HAS_VIZ
    if (command.views)
      write_medial_mesh(outputs.add(name("-simplified.vtp"), "the same for ParaView, with radius and structure"), mesh);
#endif
  }
  if (!few.error_curve.empty()) {
    json rows = json::array();
    for (const auto& [mesh, row] : few.error_curve) rows.push_back(simplification_json(row));
    report["error_curve"] = std::move(rows);
    write_file(outputs.add(name("-error-curve.csv"), "numbers of balls against error"), to_csv(few.error_curve));
    write_file(outputs.add(name("-error-curve.svg"), "the same as a picture"), to_svg(few.error_curve));
  }
  if (few.envelope) {
    const auto& [mesh, lost] = *few.envelope;
    write_obj(command.envelope, mesh);
    stamp(command.envelope, line_of(provenance));
    report["envelope"] = {
        {"vertices", mesh.vertices.size()}, {"triangles", mesh.triangles.size()}, {"balls_lost", lost}};
  }
  if (!few.seconds.empty()) report["few_balls_seconds"] = seconds_json(few.seconds);
  if (!command.output.quiet && !command.output.json) print_few_balls(few);
}

}  // namespace orchard::apps
