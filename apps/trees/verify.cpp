#include "orchard/spheretree/verify.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "command_line/commands.h"
#include "command_line/console.h"
#include "input/input_file.h"
#include "input/load_solid.h"
#include "input/reading_report.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/surface_distance.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/tree_io.h"
#include "output/json_values.h"
#include "output/outputs.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const char* violation_name(Violation::Kind kind) {
  switch (kind) {
    case Violation::Kind::uncovered:
      return "uncovered";
    case Violation::Kind::unlisted:
      return "not listed where covered";
    case Violation::Kind::other_mesh:
      return "other mesh";
    case Violation::Kind::center_distance:
      return "centre distance too low";
    case Violation::Kind::distance_bound:
      return "distance bound too low";
  }
  return "";
}

// What the tree is verified against: the mesh, repaired as `build` does it, or the wrap beside the tree that it was
// built on.
struct Subject {
  Surface surface;
  MeshReadReport reading = {};
  MeshRepairReport repair = {};  // of the mesh, where it is verified against that
  RepairDistance repair_distance = {};
  fs::path wrap = {};  // empty: the mesh itself
  SurfaceDistance wrap_to_mesh = {}, mesh_to_wrap = {};
  double wrap_distance() const { return wrap_to_mesh.upper; }
};

struct Tree {
  std::optional<runtime::PackedSphereTree> packed;
  SphereTree text;  // where it is not packed
};

Tree read_tree(const fs::path& file) {
  Tree tree;
  if (file.extension() == ".sph") {
    tree.text = read_sph(file);
    return tree;
  }
  tree.packed.emplace();
  const auto status = runtime::load_file(file.c_str(), *tree.packed);
  if (status != runtime::LoadStatus::ok) throw InputError(file.string() + ": " + runtime::message(status));
  return tree;
}

bool stores(const runtime::PackedSphereTree& tree, const TriangleMesh& mesh) {
  return tree.vertices.size() == mesh.vertices.size() && tree.triangles == mesh.triangles;
}

// Whether the tree was built on the mesh in `wrap`, which may be of another run or another program. Of a text tree, the
// packed one beside it knows.
bool built_on(const fs::path& wrap, const VerifyCommand& command, const Tree& tree, const TriangleMesh& mesh) {
  std::error_code ignored;
  if (!fs::exists(wrap, ignored) || fs::equivalent(wrap, command.mesh, ignored)) return false;
  runtime::PackedSphereTree beside;
  const runtime::PackedSphereTree* packed = tree.packed ? &*tree.packed : nullptr;
  const fs::path file = fs::path(command.tree).replace_extension(".orchard");
  if (packed == nullptr && runtime::load_file(file.c_str(), beside) == runtime::LoadStatus::ok) packed = &beside;
  if (packed == nullptr) return true;  // there is nothing else to go by
  if (stores(*packed, mesh)) return false;
  try {
    return stores(*packed, read_mesh(wrap));
  } catch (const InputError&) {
    return false;
  }
}

Subject subject_of(const VerifyCommand& command, const Tree& tree, const Progress& progress) {
  RepairedMesh read = read_repaired(command.mesh, command.input, command.join);
  Subject subject{.surface = Surface(std::move(read.mesh)),
                  .reading = std::move(read.reading),
                  .repair = std::move(read.repair),
                  .repair_distance = read.distance};
  const fs::path wrap = command.tree.parent_path() / named(command.tree, kWrapEnding);
  if (!built_on(wrap, command, tree, subject.surface.mesh())) return subject;
  Surface skin(read_mesh(wrap));
  subject.wrap_to_mesh = surface_distance(skin, subject.surface, {}, progress);
  subject.mesh_to_wrap = surface_distance(subject.surface, skin, {}, progress);
  subject.surface = std::move(skin);
  subject.repair = {};
  subject.wrap = wrap;
  return subject;
}

Verification verify_tree(const Subject& subject, Tree& tree, bool box_centered, const Progress& progress) {
  if (tree.packed) return verify(subject.surface, *tree.packed, {}, progress);
  if (box_centered)
    for (SphereNode& node : tree.text.nodes) node.sphere.center += subject.surface.bounding_box().center();
  return verify_path_rule(subject.surface, path_balls(tree.text), {}, progress);
}

json verification_json(const Verification& result, const Subject& subject) {
  const double radius = subject.surface.bounding_radius();
  json violations = json::array(), max = json::array();
  const auto index = [](Index i) { return i == kNone ? json() : json(i); };
  for (const Violation& v : result.violations)
    violations.push_back({{"kind", violation_name(v.kind)},
                          {"node", index(v.node)},
                          {"triangle", index(v.triangle)},
                          {"point", {v.point.x(), v.point.y(), v.point.z()}},
                          {"amount", v.amount}});
  for (double bound : result.max_bound) max.push_back((bound + subject.wrap_distance()) / radius);
  json report{{"ok", result.ok()},
              {"only_tangent", result.only_tangent(radius)},
              {"triangles", result.triangles},
              {"triangles_uncovered", result.triangles_uncovered},
              {"triangles_unlisted", result.triangles_unlisted},
              {"uncovered_share_likely", result.uncovered.likely_area / subject.surface.report().area},
              {"uncovered_share", bounds_json(result.uncovered.area, subject.surface.report().area)},
              {"uncovered_distance_over_radius", bounds_json(result.uncovered.distance, radius)},
              {"uncovered_nodes", result.uncovered_nodes},
              {"nodes", result.nodes},
              {"bounds_violated", result.bounds_violated},
              {"max_bound_over_radius", max},
              {"same_mesh", result.same_mesh},
              {"violations", violations}};
  if (!subject.wrap.empty())
    report["wrap"] = {{"file", subject.wrap.string()},
                      {"wrap_to_mesh_over_radius", subject.wrap_to_mesh.upper / radius},
                      {"mesh_to_wrap_over_radius", subject.mesh_to_wrap.upper / radius}};
  report["reading"] = reading_json(subject.reading);
  if (subject.repair.changed()) report["repair"] = to_json(subject.repair, subject.repair_distance, radius);
  return report;
}

void print_violations(const Verification& result) {
  for (const Violation& v : result.violations) {
    fmt::print("{}:", violation_name(v.kind));
    if (v.node != kNone) fmt::print(" node {}", v.node);
    if (v.triangle != kNone) fmt::print(" triangle {}", v.triangle);
    fmt::print(" at ({:.9g}, {:.9g}, {:.9g}) by {:.3g}\n", v.point.x(), v.point.y(), v.point.z(), v.amount);
  }
  const std::uint64_t all = result.triangles_uncovered + result.triangles_unlisted + result.bounds_violated;
  if (all > result.violations.size()) fmt::print("... and {} more\n", all - result.violations.size());
}

void print_uncovered(const Verification& result, const Surface& surface) {
  if (result.triangles_uncovered == 0) return;
  const double radius = surface.bounding_radius();
  const Bounds &area = result.uncovered.area, &depth = result.uncovered.distance;
  const auto percent = [&](double part) { return 100 * part / surface.report().area; };
  if (result.only_tangent(radius)) {
    fmt::print("spheres meet there without overlapping, which cannot be told from a gap; nodes");
    for (Index node : result.uncovered_nodes) fmt::print(" {}", node);
    fmt::print("\n");
  }
  fmt::print(
      "without a path: about {:.4g} % of the area (proven: {:.4g} to {:.4g}), {:.4g} to {:.4g} of the bounding radius "
      "deep\n",
      percent(result.uncovered.likely_area), percent(area.lower), percent(area.upper), depth.lower / radius,
      depth.upper / radius);
}

void print_verification(const fs::path& mesh, const Verification& result, const Subject& subject, double seconds) {
  const double radius = subject.surface.bounding_radius();
  print_reading(mesh, subject.reading);
  print_violations(result);
  print_uncovered(result, subject.surface);
  if (!subject.wrap.empty())
    fmt::print(
        "against the wrap {}: no point of it is farther than {:.5f} of the bounding radius from the mesh, no point "
        "of the mesh farther than {:.5f} from it\n",
        subject.wrap.string(), subject.wrap_to_mesh.upper / radius, subject.mesh_to_wrap.upper / radius);
  if (subject.repair.changed())
    fmt::print("against the repaired mesh: {}\n", in_words(subject.repair_distance, radius));
  if (!result.max_bound.empty()) {
    fmt::print("largest error bound by level, of the bounding radius{}:",
               subject.wrap.empty() ? "" : ", including the wrap's distance from the mesh");
    for (double bound : result.max_bound) fmt::print(" {:.4f}", (bound + subject.wrap_distance()) / radius);
    fmt::print("\n");
  }
  const char* verdict = result.ok() ? "OK" : result.only_tangent(radius) ? "NOT PROVEN, TANGENT" : "NOT PROVEN";
  fmt::print("{}: {} nodes, {} bounds violated; {} triangles, {} not proven covered", verdict, result.nodes,
             result.bounds_violated, result.triangles, result.triangles_uncovered);
  if (result.triangles_unlisted > 0) fmt::print(", {} not listed where they are covered", result.triangles_unlisted);
  if (!result.same_mesh) fmt::print("; the tree was built for another mesh");
  fmt::print("; {:.2f} s\n", seconds);
}

}  // namespace

bool verify(const VerifyCommand& command) {
  if (command.box_centered && command.tree.extension() != ".sph")
    throw InputError("--bbox-center has no effect on an .orchard file; it is for .sph files");
  check_input(command.tree);
  check_input(command.mesh);
  const Provenance provenance = provenance_of(command.output.run, std::array{command.tree, command.mesh});
  ProgressBar bar(!command.output.quiet && !command.output.json);
  Tree tree = read_tree(command.tree);
  const Subject subject = subject_of(command, tree, bar.callback());
  const Stopwatch watch;
  const Verification result = verify_tree(subject, tree, command.box_centered, bar.callback());
  const double seconds = watch.seconds();
  bar.clear();
  print_hole_warning(command.mesh, subject.repair, subject.repair_distance, subject.surface.bounding_radius());
  if (command.output.json) {
    json report = verification_json(result, subject);
    report["provenance"] = to_json(provenance);
    fmt::print("{}\n", report.dump(2));
  } else if (!command.output.quiet) {
    print_verification(command.mesh, result, subject, seconds);
  }
  return result.ok();
}

}  // namespace orchard::apps
