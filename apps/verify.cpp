#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "load_solid.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/error.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/tree_io.h"
#include "orchard/spheretree/verify.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

const char* name(Violation::Kind kind) {
  switch (kind) {
    case Violation::Kind::uncovered:
      return "uncovered";
    case Violation::Kind::other_mesh:
      return "other mesh";
    case Violation::Kind::center_distance:
      return "centre distance too low";
    case Violation::Kind::distance_bound:
      return "distance bound too low";
  }
  return "";
}

// A text tree has neither bounds nor lists of triangles: the path rule is all that it promises.
Verification verify_text_tree(const Surface& surface, const std::filesystem::path& file, const Progress& progress) {
  const SphereTree tree = read_sph(file);
  const std::vector<PathBall> balls = path_balls(tree);
  const Coverage coverage = surface_coverage(surface, balls, progress);
  Verification result;
  result.triangles = surface.mesh().triangles.size();
  result.nodes = tree.nodes.size();
  result.triangles_uncovered = coverage.uncovered.size();
  for (const UncoveredTriangle& uncovered : coverage.uncovered) {
    const TriangleCover& cover = uncovered.cover;
    const Index ball = cover.arcs.empty() ? kNone : cover.arcs.front().ball;
    const double depth = path_depth(cover.witness, balls);
    result.worst_depth = std::max(result.worst_depth, depth);
    if (result.violations.size() < VerifyOptions{}.most_violations)
      result.violations.push_back({Violation::Kind::uncovered, ball, uncovered.triangle, cover.witness, depth});
  }
  return result;
}

Verification verify_packed_tree(const Surface& surface, const std::filesystem::path& file, const Progress& progress) {
  runtime::PackedSphereTree tree;
  const auto status = runtime::load_file(file.c_str(), tree);
  if (status != runtime::LoadStatus::ok) throw InputError(file.string() + ": " + runtime::message(status));
  return verify(surface, tree, {}, progress);
}

json to_json(const Verification& result, double radius) {
  json violations = json::array();
  const auto index = [](Index i) { return i == kNone ? json() : json(i); };
  for (const Violation& v : result.violations)
    violations.push_back({{"kind", name(v.kind)},
                          {"node", index(v.node)},
                          {"triangle", index(v.triangle)},
                          {"point", {v.point.x(), v.point.y(), v.point.z()}},
                          {"amount", v.amount}});
  return {{"ok", result.ok()},
          {"triangles", result.triangles},
          {"triangles_uncovered", result.triangles_uncovered},
          {"worst_depth_over_radius", result.worst_depth / radius},
          {"nodes", result.nodes},
          {"bounds_violated", result.bounds_violated},
          {"same_mesh", result.same_mesh},
          {"violations", violations}};
}

void print(const Verification& result, double radius, double seconds) {
  for (const Violation& v : result.violations) {
    fmt::print("{}:", name(v.kind));
    if (v.node != kNone) fmt::print(" node {}", v.node);
    if (v.triangle != kNone) fmt::print(" triangle {}", v.triangle);
    fmt::print(" at ({:.9g}, {:.9g}, {:.9g}) by {:.3g}\n", v.point.x(), v.point.y(), v.point.z(), v.amount);
  }
  const std::uint64_t all = result.triangles_uncovered + result.bounds_violated;
  if (all > result.violations.size()) fmt::print("... and {} more\n", all - result.violations.size());
  fmt::print("{}: {} nodes, {} bounds violated; {} triangles, {} not proven covered", result.ok() ? "OK" : "NOT PROVEN",
             result.nodes, result.bounds_violated, result.triangles, result.triangles_uncovered);
  if (result.triangles_uncovered > 0)
    fmt::print(", worst depth {:.3g} of the bounding radius", result.worst_depth / radius);
  if (!result.same_mesh) fmt::print("; the tree was built for another mesh");
  fmt::print("; {:.2f} s\n", seconds);
}

}  // namespace

bool verify(const VerifyCommand& command) {
  TriangleMesh mesh = read_repaired(command.mesh).mesh;
  const bool text = command.tree.extension() == ".sph";
  const Surface surface(std::move(mesh));
  ProgressBar bar(!command.output.quiet && !command.output.json);
  const Stopwatch watch;
  const Verification result = text ? verify_text_tree(surface, command.tree, bar.callback())
                                   : verify_packed_tree(surface, command.tree, bar.callback());
  const double seconds = watch.seconds();
  bar.clear();
  if (command.output.json) {
    fmt::print("{}\n", to_json(result, surface.bounding_radius()).dump(2));
  } else if (!command.output.quiet) {
    print(result, surface.bounding_radius(), seconds);
  }
  return result.ok();
}

}  // namespace orchard::apps
