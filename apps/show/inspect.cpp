#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "command_line/commands.h"
#include "input/input_file.h"
#include "input/reading_report.h"
#include "input/standard_input.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_details.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/tree_io.h"
#include "output/report.h"
#include "show/inspect_other.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

struct LevelSummary {
  Index spheres = 0, leaves = 0;
  double mean_radius = 0, max_radius = 0, max_error = 0;
};

// By level, the root's first. `max_error` is the largest bound on the distance of a ball's points from the solid.
json levels_json(const SphereTree& tree) {
  std::vector<LevelSummary> levels(tree.depth() + std::size_t{1});
  for (const SphereNode& node : tree.nodes) {
    LevelSummary& level = levels[node.level];
    ++level.spheres;
    level.leaves += node.child_count == 0 ? 1 : 0;
    level.mean_radius += node.sphere.radius;
    level.max_radius = std::max(level.max_radius, node.sphere.radius);
    level.max_error = std::max(level.max_error, node.distance_bound);
  }
  json rows = json::array();
  for (const LevelSummary& level : levels) {
    rows.push_back({{"spheres", level.spheres},
                    {"leaves", level.leaves},
                    {"mean_radius", level.mean_radius / std::max<Index>(1, level.spheres)},
                    {"max_radius", level.max_radius},
                    {"max_error", level.max_error}});
  }
  return rows;
}

json inspect_packed(const std::filesystem::path& file) {
  runtime::PackedSphereTree tree;
  const auto status = runtime::load_file(file.c_str(), tree);
  if (status != runtime::LoadStatus::ok) throw InputError(file.string() + ": " + runtime::message(status));
  return {{"kind", "sphere-tree"},
          {"nodes", tree.node_count},
          {"branching", tree.branching},
          {"depth", tree.depth},
          {"triangles", tree.triangles.size()},
          {"bounding_radius", tree.bounding_radius},
          {"vertex_error", tree.vertex_error},
          {"origin", tree.origin},
          {"bytes_per_node", static_cast<double>(tree.blocks.size() * sizeof(runtime::SiblingBlock)) / tree.node_count},
          {"levels", levels_json(unpack(tree))}};
}

json inspect_sph(const std::filesystem::path& file) {
  SphereTree tree = read_sph(file);
  for (SphereNode& node : tree.nodes) node.distance_bound = 0;  // the file says nothing of it
  return {{"kind", "sphere-tree"},
          {"nodes", tree.nodes.size()},
          {"branching", tree.branching},
          {"depth", tree.depth()},
          {"levels", levels_json(tree)}};
}

json inspect_mesh(const InspectCommand& command) {
  auto [read, reading] = read_input(command.file, command.input);
  const Surface surface(std::move(read));
  const MeshDetails details = mesh_details(surface.mesh(), surface.report());
  json report = mesh_json(surface);
  report["kind"] = "mesh";
  report["reading"] = reading_json(reading);
  report["faults"] = surface.report().faults();
  report["unused_vertices"] = surface.report().unused_vertices;
  report["inside_out_components"] = surface.report().inside_out_components;
  report["boundary_loops"] = details.boundary_loops;
  report["duplicate_triangles"] = details.duplicate_triangles;
  report["coincident_vertices"] = details.coincident_vertices;
  report["genus"] = details.genus ? json(*details.genus) : json();
  if (command.full || surface.mesh().triangles.size() <= kMaxForSelfIntersections)
    report["self_intersections"] = surface.self_intersections().size();
  TriangleMesh mesh = surface.mesh();
  const MeshRepairReport repair = repair_mesh(mesh, repair_options(command.join));
  const MeshReport repaired = check_mesh(mesh);
  RepairDistance distance;
  if (repair.solid && repair.changed()) distance = repair_distance(surface.mesh(), Surface(std::move(mesh)));
  report["repair"] = to_json(repair, distance, surface.bounding_radius());
  report["repair"]["vertices"] = repaired.vertices;
  report["repair"]["triangles"] = repaired.triangles;
  report["repair"]["volume"] = repaired.volume;
  report["repair"]["solid"] = repair.solid;
  report["repair"]["faults"] = repair.faults;
  report["repair"]["holes_left_in_words"] = holes_left(repair);
  return report;
}

RepairDistance distance_of(const json& repair) {
  const auto bounds = [&](const char* key) {
    return SurfaceDistance{.lower = repair[key][0].get<double>(), .upper = repair[key][1].get<double>()};
  };
  return {.to_input = bounds("repaired_to_input"), .from_input = bounds("input_to_repaired")};
}

// What a mesh's numbers mean for a sphere-tree of it.
void print_verdict(const json& report) {
  const auto faults = report["faults"].get<std::string>();
  if (!report.contains("self_intersections")) {
    fmt::print("not looked for: self-intersections; --full does\n");
  } else if (const auto pairs = report["self_intersections"].get<std::size_t>(); pairs > 0) {
    fmt::print("{} of triangles cut or touch each other; --wrap makes one skin of them\n",
               pairs == 1 ? std::string("1 pair") : fmt::format("{} pairs", pairs));
  }
  fmt::print("{}\n", faults.empty() ? "a solid: closed, manifold, oriented outward" : "not a solid: " + faults);
  const json& repair = report["repair"];
  for (const json& line : repair["lines"]) fmt::print("repair: {}\n", line.get<std::string>());
  if (repair["solid"].get<bool>() && !repair["lines"].empty())
    fmt::print("repair makes a solid of it: {}; {} vertices, {} triangles, volume {:.8g}\n",
               in_words(distance_of(repair), report["bounding_ball"][3].get<double>()), repair["vertices"].get<Index>(),
               repair["triangles"].get<Index>(), repair["volume"].get<double>());
  if (!repair["solid"].get<bool>())
    fmt::print(
        "no closed manifold, even after repair: {}{}; \"orchard build --wrap\" builds on a closed skin around it\n",
        repair["faults"].get<std::string>(), repair["holes_left_in_words"].get<std::string>());
}

void print_levels(const json& levels) {
  fmt::print("level  spheres   leaves  mean radius   max radius    max error\n");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const json& level = levels[i];
    fmt::print("{:5} {:8} {:8} {:12.6g} {:12.6g} {:12.6g}\n", i, level["spheres"].get<Index>(),
               level["leaves"].get<Index>(), level["mean_radius"].get<double>(), level["max_radius"].get<double>(),
               level["max_error"].get<double>());
  }
}

// The unit of a value in a report: of a length, an area or a volume; empty for other values.
std::string unit_of(const std::string& key, const std::string& unit) {
  if (unit.empty()) return {};
  for (const char* length :
       {"diagonal", "border_length", "radii", "bounds", "bounding_ball", "bounding_radius", "buffer"})
    if (key == length) return " " + unit;
  if (key == "area") return fmt::format(" {}^2", unit);
  if (key == "volume" || key == "sum_of_volumes") return fmt::format(" {}^3", unit);
  return {};
}

// A value as a reader wants it: eight digits, words without quotes.
std::string in_words(const json& value) {
  if (value.is_number_float()) return fmt::format("{:.8g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const json& item : value) text += (text.empty() ? "" : ", ") + in_words(item);
  return !value.empty() && value[0].is_array() ? text : "(" + text + ")";
}

void print_inspected(const std::filesystem::path& file, const std::string& unit, const json& report) {
  fmt::print("{}: {}\n", shown(file), report["kind"].get<std::string>());
  if (report.contains("reading"))
    for (const json& line : report["reading"]["lines"]) fmt::print("{}: {}\n", shown(file), line.get<std::string>());
  for (const auto& [key, value] : report.items()) {
    if (key == "kind" || key == "levels" || key == "faults" || key == "repair" || key == "reading") continue;
    fmt::print("  {:24} {}{}\n", key, in_words(value), unit_of(key, unit));
  }
  if (report.contains("levels")) print_levels(report["levels"]);
  if (report.contains("faults")) print_verdict(report);
}

bool is_among(const std::string& extension, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return extension == name; });
}

// By the ending of the file; those that several kinds of files have are told apart by what is in them.
json inspect_file(const InspectCommand& command) {
  const std::string extension =
      command.input.format.empty() ? lower_extension(command.file) : "." + command.input.format;
  if (extension == ".orchard") return inspect_packed(command.file);
  if (extension == ".sph") return inspect_sph(command.file);
  if (is_among(extension, {".ma", ".ma_dup", ".ma_struct", ".swc", ".cg", ".cgal"})) return inspect_axis(command.file);
  if (is_among(extension, {".txt", ".csv", ".json", ".yml", ".yaml", ".xrdf", ".urdf"}))
    return inspect_spheres(command.file);
  if (is_among(extension, {".xyz", ".obj", ".ply"})) {
    if (std::optional<json> points = inspect_points(command.file, command.input)) return *std::move(points);
  }
  return inspect_mesh(command);
}

}  // namespace

void inspect(const InspectCommand& command) {
  check_input(command.file);
  const Provenance provenance = provenance_of(command.output.run, std::array{command.file});
  json report = inspect_file(command);
  const std::string unit = report.contains("reading") && report["reading"]["unit"].is_string()
                               ? report["reading"]["unit"].get<std::string>()
                               : command.input.unit;
  if (!unit.empty()) report["unit"] = unit;
  if (report["kind"] != "mesh" && (command.full || command.join))
    throw InputError(fmt::format("{} has no effect on {}; it is for meshes", command.full ? "--full" : "--join",
                                 command.file.string()));
  if (command.output.json) {
    report["provenance"] = to_json(provenance);
    fmt::print("{}\n", report.dump(2));
  } else if (!command.output.quiet) {
    print_inspected(command.file, unit, report);
  }
  if (report.contains("repair") && report["repair"]["warning"].is_string())
    print_warning(command.file, report["repair"]["warning"]);
}

}  // namespace orchard::apps
