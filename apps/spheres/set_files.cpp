#include "spheres/set_files.h"

#include <fmt/format.h>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/ball_tree.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/proven.h"
#include "output/sphere_arrays.h"
#include "report/report_page.h"
#include "spheres/sphere_views.h"
#include "spheres/spheres_output.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr const char* kTreeEnding = "-set.orchard";

std::string link_of(const SpheresCommand& command) {
  return command.link.empty() ? command.mesh.stem().string() : command.link;
}

std::string bytes_of(const runtime::PackedSphereTree& packed) {
  const auto bytes = runtime::serialize(packed);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::vector<std::string> set_file_names(const SpheresCommand& command) {
  std::vector<std::string> endings = sphere_view_endings("-set");
  for (const char* ending : {"-set.txt", "-set.csv", "-set.npz", "-set-spheres.json", "-set.yml", "-set.urdf",
                             kTreeEnding, "-set.png", "-set-error-curve.csv", "-set-error-curve.svg"})
    endings.emplace_back(ending);
  endings.emplace_back(command.reading.wrap.empty() ? kRepairedEnding : kWrapEnding);
  endings.emplace_back(kClippedEnding);
  std::vector<std::string> names;
  names.reserve(endings.size() + 1);
  for (const std::string& ending : endings) names.push_back(named(command.mesh, ending));
  names.push_back(page_name(command.mesh, "spheres"));
  return names;
}

std::vector<std::string> set_files(const SpheresCommand& command) {
  std::vector<std::string> names;
  for (const char* ending : {"-set.txt", "-set.csv", "-set-spheres.json", "-set.yml", "-set.urdf", kTreeEnding})
    names.push_back(named(command.mesh, ending));
  return names;
}

void write_set(const SpheresCommand& command, const Provenance& provenance, const SetToWrite& set, Outputs& outputs) {
  const auto write = [&](const char* ending, std::string_view bytes, const char* what) {
    write_file(outputs.add(named(command.mesh, ending), what), bytes);
  };
  const std::span<const double> masses =
      set.particles != nullptr ? std::span<const double>(set.particles->masses) : std::span<const double>();
  const std::string columns = masses.empty() ? "x y z r" : "x y z r mass";
  write("-set.txt",
        to_text(set.spheres, masses,
                {fmt::format("{} of {} spheres; {}", columns, set.spheres.size(), set.title), line_of(provenance)}),
        ("the spheres as text, " + columns).c_str());
  for (const std::string& format : command.exports) {
    if (format == "csv") write("-set.csv", to_csv(set.spheres, masses), "the same as a table");
    if (format == "npz") write("-set.npz", to_npz(set_arrays(set.spheres, masses)), "the same as arrays for NumPy");
    if (format == "yaml") write("-set.yml", to_yaml(set.spheres, link_of(command)), "the same as cuRobo reads it");
    if (format == "urdf")
      write("-set.urdf", set_as_urdf(set.spheres, link_of(command), set.particles),
            "the same as a link's collision geometry");
    if (format != "json") continue;
    json spheres = to_json(set.spheres, masses);
    spheres["provenance"] = decisive_json(provenance);
    write("-set-spheres.json", spheres.dump(1) + "\n", "the same as lists of centres and radii");
  }
}

std::string cover_tree(const Surface& surface, std::span<const Sphere> spheres) {
  SphereTree tree = ball_tree(spheres);
  measure(tree, surface);
  const ProvenTree proven = pack_proven(tree, surface);
  if (!proven.proof.ok()) throw Error("the tree over the spheres is not proven to hold the surface");
  return bytes_of(proven.packed);
}

std::string union_tree(std::span<const Sphere> spheres) {
  const BallTree tree = pack_balls(spheres);
  if (tree.balls_unproven > 0 || tree.bounds_unproven > 0)
    throw Error(
        fmt::format("the tree is not proven to hold {} of the {} spheres", tree.balls_unproven, spheres.size()));
  return bytes_of(tree.packed);
}

void write_cover_tree(const SpheresCommand& command, const Surface& surface, std::span<const Sphere> spheres,
                      Outputs& outputs) {
  write_file(outputs.add(named(command.mesh, kTreeEnding), "a tree over them that holds the surface, for the run-time"),
             cover_tree(surface, spheres));
}

void write_union_tree(const SpheresCommand& command, std::span<const Sphere> spheres, Outputs& outputs) {
  write_file(outputs.add(named(command.mesh, kTreeEnding),
                         "a tree of which the union of the spheres is the object, for the run-time"),
             union_tree(spheres));
}

}  // namespace orchard::apps
