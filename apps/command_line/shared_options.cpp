#include "command_line/shared_options.h"

#include <fmt/core.h>

#include "command_line/number_validator.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::apps {

std::vector<std::string> given_of(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> given;
  for (const CLI::Option* option : options)
    if (option->count() > 0 && !option->get_lnames().empty()) given.push_back(option->get_lnames().front());
  return given;
}

std::vector<std::string> given_of(const CLI::App& command) { return given_of(command.get_options()); }

void add_mesh(CLI::App& command, std::filesystem::path& mesh) {
  command.add_option("mesh", mesh, "The mesh: .obj, .ply, .stl or .off")->required();
}

void add_threads(CLI::App& command, Request& request) {
  command.add_option("--threads", request.threads, "Threads at most; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
}

CLI::Option* add_up(CLI::App& command, std::string& up) {
  return command.add_option("--up", up, "The mesh's axis that points up in the picture")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
}

void add_output_flags(CLI::App& command, Output& output) {
  command.add_flag("--quiet", output.quiet, "Print nothing but errors");
  command.add_flag("--json", output.json, "Print a JSON report instead of a table, --quiet or not");
}

void add_accept(CLI::App& command, bool& accept) {
  command.add_flag("--accept", accept,
                   "Exit with 0 although the result lacks something that was promised: it is said all the same");
}

CLI::Option* add_join(CLI::App& command, std::optional<double>& join) {
  return command
      .add_option(
          "--join", join,
          fmt::format("Corners of open edges up to this far apart are one, in bounding radii; 0: none (default: {:g})",
                      tolerance::kJoin))
      ->check(NumberValidator(CLI::Range(0.0, kMaxJoin)));
}

CLI::Option* add_force(CLI::App& command, Output& output) {
  return command.add_flag("--force", output.force,
                          "Replace the files of another input of the same name; without it the command refuses to");
}

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  auto* strict =
      command.add_flag("--strict", options.strict, "Refuse a mesh that is no closed manifold instead of repairing it");
  auto* wrap =
      command
          .add_flag("--wrap{" + kDefaultWrap + "}", options.wrap,
                    "Build on a closed skin around the mesh; =OFFSET: about how far outside, in diagonals of its box")
          ->excludes(strict);
  command
      .add_option(
          "--wrap-alpha", options.wrap_alpha,
          "Openings narrower than this stay closed, in diagonals; less follows the mesh better, and takes longer")
      ->check(NumberValidator(CLI::Range(1e-4, 0.5)))
      ->needs(wrap)
      ->capture_default_str();
  command
      .add_option_function<double>(
          "--fill-holes", [&options](double width) { options.fill_holes = width; },
          "Fill holes up to this width, in bounding radii, whatever their edges (default: 0.5, and of at most 100 "
          "edges)")
      ->check(NumberValidator(CLI::Range(0.0, 2.0)))
      ->excludes(strict)
      ->excludes(wrap);
  add_join(command, options.join)->excludes(strict)->excludes(wrap);
  command
      .add_option_function<std::string>(
          "--root-ball",
          [&options](const std::string& name) {
            options.ball = name == "ritter" ? BoundingBall::ritter : BoundingBall::minimal;
          },
          "The ball around the whole, the root of the tree: minimal (default), or ritter for that of Ritter's method")
      ->check(CLI::IsMember({"minimal", "ritter"}));
}

// Those that the command has a use for.
void add_tuning(CLI::App& command, MedialTuning& tuning, bool for_tree) {
  for (const TuningFlag& flag : tuning_flags()) {
    if (for_tree && flag.step >= TuningStep::refining) continue;
    const bool needs = for_tree && flag.name == "samples";
    const bool of_all = for_tree && flag.name == "seed";  // no axis is needed to use it
    const std::string help = of_all ? "Of all random choices: another tree, about as good" : flag.help;
    command
        .add_option_function<std::string>(
            "--" + flag.name, [&tuning, &flag](const std::string& value) { flag.set(tuning, value); },
            help + " [" + (needs ? "as method and depth need" : flag.standard) + "]")
        ->check(CLI::Validator([&flag](std::string& value) { return flag.fault(value); }, "{" + flag.range() + "}"))
        ->group(of_all     ? "Options"
                : for_tree ? "Medial axis, for --method tightened and merging"
                           : "Tuning");
  }
}

void add_axis_source(CLI::App& command, AxisSource& source) {
  command.add_option("--points", source.points, "Your own surface points: .xyz, .ply or .obj");
  command.add_option("--diagram", source.diagram,
                     "Your own Voronoi diagram of points on the mesh, a .vor file; its gaps are not repaired");
}

}  // namespace orchard::apps
