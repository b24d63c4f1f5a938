#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "spheres/set_files.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Refuses all options that have no effect on spheres that exist already.
void refuse_idle(const SpheresCommand& command) {
  constexpr std::array kOf{"output", "export", "link", "tree", "force", "quiet", "json", "threads", "no-views"};
  for (const std::string& option : command.given)
    if (std::find(kOf.begin(), kOf.end(), option) == kOf.end())
      throw InputError(
          fmt::format("{}: --{} has no effect on a file of spheres; it is for meshes", command.mesh.string(), option));
}

}  // namespace

bool names_spheres(const fs::path& input) {
  constexpr std::array kEndings{".txt",  ".csv",  ".xyz", ".json", ".yml", ".yaml", ".xrdf",
                                ".urdf", ".srdf", ".xml", ".mol",  ".py",  ".sph",  ".orchard"};
  const std::string ending = lower_extension(input);
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

ExitCode spheres_of_file(const SpheresCommand& command) {
  check_input(command.mesh);
  refuse_idle(command);
  const std::vector<fs::path> inputs{command.mesh};
  Destination destination{.folder = command.folder,
                          .report = named(command.mesh, "-set.json"),
                          .provenance = provenance_of(command.output.run, inputs),
                          .force = command.output.force};
  keep_single_file(destination, set_files(command));
  check_outputs(destination, set_file_names(command), inputs);
  const SphereFile file = read_sphere_file(command.mesh);
  const SphereGroup& group = group_named(file, command.mesh, command.link);
  if (group.spheres.empty()) throw InputError(command.mesh.string() + ": all spheres are switched off");
  const std::string title =
      fmt::format("as in {}{}", command.mesh.filename().string(), group.name.empty() ? "" : ", " + group.name);
  Outputs outputs(destination);
  write_set(command, destination.provenance, {.spheres = group.spheres, .title = title}, outputs);
  if (command.tree) write_union_tree(command, group.spheres, outputs);
  json report{{"spheres", group.spheres.size()},
              {"format", file.format},
              {"link", group.name},
              {"switched_off", group.switched_off},
              {"tree", command.tree}};
  outputs.add_report(report, "this report as JSON");
  outputs.commit();
  if (command.output.json) fmt::print("{}\n", report.dump(2));
  if (command.output.quiet || command.output.json) return kSucceeded;
  fmt::print("{}: {} spheres ({}){}\n", command.mesh.string(), group.spheres.size(), file.format,
             group.switched_off > 0 ? fmt::format(", and {} switched off: radius zero or below", group.switched_off)
                                    : std::string());
  outputs.print();
  if (command.tree)
    fmt::print("PROMISED: every point of the union of the spheres lies in all spheres of a path of the tree; proven\n");
  return kSucceeded;
}

}  // namespace orchard::apps
