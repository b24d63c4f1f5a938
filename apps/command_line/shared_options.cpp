#include "command_line/shared_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include "command_line/number_validator.h"
#include "orchard/geometry/tolerance.h"
#include "output/outputs.h"

namespace orchard::apps {
namespace {

constexpr const char* kPrune = "prune";
constexpr const char* kTreeAxisGroup = "Medial axis (for --method tightened and merging)";

// The measures by which axes are pruned. `tuning` must outlive them.
std::vector<PruneMeasure> prune_measures(MedialTuning& tuning) {
  std::vector<PruneMeasure> measures;
  for (const TuningFlag& flag : tuning_flags()) {
    if (flag.step != TuningStep::pruning) continue;
    measures.push_back({.name = flag.name.substr(std::string(kPrune).size() + 1),
                        .help = flag.help,
                        .standard = flag.standard,
                        .range = flag.range(),
                        .fault = [&flag](const std::string& value) { return flag.fault(value); },
                        .set = [&flag, &tuning](const std::string& value) { flag.set(tuning, value); }});
  }
  return measures;
}

// given_of() names each measure that is given, as "prune angle".
CLI::Option* add_prune(CLI::App& command, const std::vector<PruneMeasure>& measures) {
  std::string help = "MEASURE=VALUE: remove what is insignificant. May be repeated.", names;
  for (const PruneMeasure& measure : measures) {
    help += fmt::format(" {} ({}) [{}]: {}{}", measure.name, measure.range, measure.standard, measure.help,
                        &measure == &measures.back() ? "" : ".");
    names += (names.empty() ? "" : ", ") + measure.name;
  }
  const auto measure_of = [measures](const std::string& text) -> std::optional<PruneMeasure> {
    const std::string name = text.substr(0, text.find('='));
    for (const PruneMeasure& measure : measures)
      if (measure.name == name) return measure;
    return std::nullopt;
  };
  const auto fault = [measure_of, names](std::string& text) -> std::string {
    const std::size_t equals = text.find('=');
    const std::optional<PruneMeasure> measure = measure_of(text);
    if (equals == std::string::npos || !measure)
      return fmt::format("expected MEASURE=VALUE, where MEASURE is one of {}, not {}", names, text);
    const std::string wrong = measure->fault(text.substr(equals + 1));
    return wrong.empty() ? wrong : measure->name + ": " + wrong;
  };
  return command
      .add_option_function<std::vector<std::string>>(
          fmt::format("--{}", kPrune),
          [measure_of](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) measure_of(text)->set(text.substr(text.find('=') + 1));
          },
          help)
      ->check(CLI::Validator(fault, "MEASURE=VALUE"))
      ->allow_extra_args(false);
}

}  // namespace

std::vector<std::string> given_of(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> given;
  for (const CLI::Option* option : options) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (name != kPrune) given.push_back(name);
    for (const std::string& value : name == kPrune ? option->results() : std::vector<std::string>{})
      given.push_back(name + " " + value.substr(0, value.find('=')));
  }
  return given;
}

std::vector<std::string> given_of(const CLI::App& command) { return given_of(command.get_options()); }

std::string mesh_help(const std::string& what) {
  return what + " " + input_formats_in_words() + ", or - for standard input";
}

void add_mesh_input(CLI::App& command, MeshInput& input) {
  command.add_option("--format", input.format, "Format of the mesh (default: the ending of its name)")
      ->check(CLI::IsMember(input_formats()));
  command.add_option("--scale", input.scale, "Multiply the coordinates of the mesh by this factor")
      ->check(NumberValidator(CLI::Range(1e-12, 1e12)))
      ->capture_default_str();
  command
      .add_option("--unit", input.unit,
                  "Name of the mesh's unit, after --scale, such as mm, to print and write beside lengths. It converts "
                  "nothing")
      ->check(CLI::Validator(
          [](std::string& name) {
            const bool word = !name.empty() && name.size() <= 16 && std::all_of(name.begin(), name.end(), [](char c) {
              return std::isalnum(static_cast<unsigned char>(c)) != 0;
            });
            return word ? std::string() : "expected a word of at most 16 letters and digits, such as mm";
          },
          "{a word}"));
}

void add_mesh(CLI::App& command, Request& request, std::filesystem::path& mesh, MeshInput& input) {
  command.add_option("mesh", mesh, mesh_help("Mesh to read"))->required();
  request.meshes.push_back({&mesh, &input});
  add_mesh_input(command, input);
}

void add_threads(CLI::App& command, Request& request) {
  command
      .add_option("--threads", request.threads,
                  "Use at most this many threads (default: one per processor). The result does not depend on it")
      ->check(CLI::Range(1, 1024));
}

CLI::Option* add_up(CLI::App& command, std::string& up) {
  return command.add_option("--up", up, "Axis of the mesh that points up in the picture")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
}

void add_output_flags(CLI::App& command, Output& output) {
  command.add_flag("--quiet", output.quiet, "Print errors only");
  command.add_flag("--json", output.json, "Print the report as JSON in place of a table, also with --quiet");
}

void add_accept(CLI::App& command, bool& accept) {
  command.add_flag("--accept", accept,
                   "Exit with 0 even if the result does not keep a promise. The report still says so");
}

CLI::Option* add_join(CLI::App& command, std::optional<double>& join) {
  return command
      .add_option("--join", join,
                  fmt::format("Join corners of open edges that are at most this far apart, in bounding radii (default: "
                              "{:g}). 0 joins none",
                              tolerance::kJoin))
      ->check(NumberValidator(CLI::Range(0.0, kMaxJoin)));
}

CLI::Option* add_report(CLI::App& command, bool& report) {
  return command.add_flag("--report", report,
                          "Also write the report as an .html page that needs no other file: tables with explanations, "
                          "plots and pictures");
}

void export_single_file(const std::filesystem::path& output, const std::vector<std::string>& kinds,
                        std::vector<std::string>& exports) {
  for (const std::string& kind : kinds) {
    const std::string ending = "." + (kind == "yaml" ? std::string("yml") : kind);
    if (file_ending(output, std::array{ending}).empty()) continue;
    if (std::find(exports.begin(), exports.end(), kind) == exports.end()) exports.push_back(kind);
  }
}

CLI::Option* add_force(CLI::App& command, Output& output) {
  return command.add_flag("--force", output.force,
                          "Overwrite output files that belong to another input of the same name");
}

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  auto* strict = command.add_flag("--strict", options.strict,
                                  "Refuse a mesh that is not a closed manifold instead of repairing it");
  auto* wrap = command
                   .add_flag("--wrap{" + kDefaultWrap + "}", options.wrap,
                             "Replace the mesh by a closed skin around it, for scans and open meshes. --wrap=OFFSET "
                             "sets the distance of the skin from the mesh, in diagonals")
                   ->excludes(strict);
  command
      .add_option("--wrap-alpha", options.wrap_alpha,
                  "Width of openings that the skin closes, in diagonals. Lower values follow the mesh more closely and "
                  "take longer")
      ->check(NumberValidator(CLI::Range(1e-4, 0.5)))
      ->needs(wrap)
      ->capture_default_str();
  command
      .add_option_function<double>(
          "--fill-holes", [&options](double width) { options.fill_holes = width; },
          "Fill holes up to this width, in bounding radii, whatever their number of edges (default: holes of at most "
          "100 "
          "edges up to a width of 0.5)")
      ->check(NumberValidator(CLI::Range(0.0, 2.0)))
      ->excludes(strict)
      ->excludes(wrap);
  add_join(command, options.join)->excludes(strict)->excludes(wrap);
  command
      .add_option_function<std::string>(
          "--union", [&options](const std::string& answer) { options.unite = answer == "yes"; },
          std::string("Replace closed parts that cut each other by their union (default: ") +
              (options.unite ? "yes" : "no") + ")")
      ->check(CLI::IsMember({"yes", "no"}))
      ->excludes(strict)
      ->excludes(wrap);
  command
      .add_option_function<std::string>(
          "--root-ball",
          [&options](const std::string& name) {
            options.ball = name == "ritter" ? BoundingBall::ritter : BoundingBall::minimal;
          },
          "Bounding sphere of the mesh, which is also the root of trees: the smallest one (minimal, default) or that "
          "of "
          "Ritter's method (ritter)")
      ->check(CLI::IsMember({"minimal", "ritter"}));
}

void add_side(CLI::App& command, MedialCommand& medial) {
  CLI::Option* side = command
                          .add_option_function<std::string>(
                              "--side", [&medial](const std::string& name) { medial.outside = name == "outside"; },
                              "Build the axis of the solid (inside, default) or of the space around it (outside)")
                          ->check(CLI::IsMember({"inside", "outside"}));
  command
      .add_option("--outside-radius", medial.outside_radius,
                  "Radius of the sphere that bounds the outside, in bounding radii")
      ->check(NumberValidator(CLI::Range(1.1, 1000.0)))
      ->needs(side)
      ->capture_default_str();
}

// Those that the command has a use for.
void add_tuning(CLI::App& command, MedialTuning& tuning, bool for_tree, std::vector<PruneMeasure> measures) {
  for (const TuningFlag& flag : tuning_flags()) {
    if (flag.step == TuningStep::pruning || (for_tree && flag.step >= TuningStep::refining)) continue;
    const bool needs = for_tree && flag.name == "samples";
    const bool of_all = for_tree && flag.name == "seed";  // no axis is needed to use it
    const std::string help =
        of_all ? "Seed of all random choices. Another seed gives another tree of about the same tightness" : flag.help;
    command
        .add_option_function<std::string>(
            "--" + flag.name, [&tuning, &flag](const std::string& value) { flag.set(tuning, value); },
            help + " [" + (needs ? "as method and depth need" : flag.standard) + "]")
        ->check(CLI::Validator([&flag](std::string& value) { return flag.fault(value); }, "{" + flag.range() + "}"))
        ->group(of_all     ? "Options"
                : for_tree ? kTreeAxisGroup
                           : "Tuning");
  }
  const std::vector<PruneMeasure> own = measures;
  for (PruneMeasure& measure : prune_measures(tuning)) {
    // A measure of the command itself, such as the erosion of a skeleton, is meant by a name that both have.
    const auto is_same = [&](const PruneMeasure& other) { return other.name == measure.name; };
    if (std::none_of(own.begin(), own.end(), is_same)) measures.push_back(std::move(measure));
  }
  add_prune(command, measures)->group(for_tree ? kTreeAxisGroup : "Tuning");
}

void add_axis_source(CLI::App& command, AxisSource& source) {
  command.add_option("--points", source.points,
                     "Use these surface points instead of sampling the mesh (.xyz, .ply or .obj)");
  command.add_option(
      "--diagram", source.diagram,
      "Use this Voronoi diagram of points on the mesh (.vor) instead of building one. Its gaps are not repaired");
}

}  // namespace orchard::apps
