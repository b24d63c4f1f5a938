#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "command_line/commands.h"
#include "input/input_file.h"
#include "input/load_tree.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/error.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/shape_query.h"

namespace orchard::apps {
namespace {

using nlohmann::json;
using runtime::Answer;

// "tx ty tz qw qx qy qz", or with commas between them; a quaternion of any length but zero.
runtime::Pose parse_pose(const std::string& text, const char* option) {
  if (text.empty()) return {};
  const auto fail = [&] {
    throw InputError(std::string(option) + " \"" + text +
                     "\": expected seven finite numbers, a translation and a "
                     "quaternion other than zero: \"tx ty tz qw qx qy qz\"");
  };
  std::array<double, 7> v{};
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto skip_blanks = [&] {
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
  };
  for (double& value : v) {
    skip_blanks();
    if (&value != &v.front() && at != end && *at == ',') ++at;
    skip_blanks();
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) fail();
    at = next;
  }
  skip_blanks();
  if (at != end) fail();
  const auto pose = runtime::pose_from_quaternion({v[3], v[4], v[5], v[6]}, {v[0], v[1], v[2]});
  if (!pose) fail();
  return *pose;
}

const char* answer_name(Answer answer) {
  switch (answer) {
    case Answer::no:
      return "no";
    case Answer::maybe:
      return "maybe";
    case Answer::yes:
      return "yes";
  }
  return "";
}

// What is known after one level. Bounds are finite once the roots met.
json row(const runtime::NarrowPhase& narrow, const std::string& level, double microseconds) {
  json entry{{"level", level},
             {"answer", answer_name(narrow.answer())},
             {"pairs", narrow.progress().pairs},
             {"sphere_tests", narrow.progress().pair_tests},
             {"triangle_tests", narrow.progress().triangle_tests},
             {"lower_bound", narrow.lower_bound()},
             {"microseconds", microseconds}};
  entry["separation_bound"] = std::isfinite(narrow.separation_bound()) ? json(narrow.separation_bound()) : json();
  return entry;
}

json run(runtime::NarrowPhase& narrow, const runtime::Pose& a, const runtime::Pose& b) {
  using Clock = std::chrono::steady_clock;
  const auto timed = [](auto&& step) {
    const auto begin = Clock::now();
    step();
    return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
  };
  // An untimed first run, so that the times below are those of a query that a program makes in every frame.
  narrow.start(a, b);
  while (!narrow.finished()) narrow.refine();
  json levels = json::array();
  double microseconds = timed([&] { narrow.start(a, b); });
  levels.push_back(row(narrow, "0", microseconds));
  while (!narrow.finished()) {
    microseconds = timed([&] { narrow.refine(); });
    levels.push_back(
        row(narrow, narrow.progress().exact ? "exact" : std::to_string(narrow.progress().level), microseconds));
  }
  return levels;
}

// One vertex of each connected piece of the surface, in the tree's frame.
std::vector<std::array<double, 3>> pieces_of(const runtime::PackedSphereTree& tree) {
  DisjointSets joined(tree.vertices.size());
  for (const auto& triangle : tree.triangles) {
    for (const std::uint32_t v : triangle) joined.unite(triangle[0], v);
  }
  std::vector<bool> seen(tree.vertices.size());
  std::vector<std::array<double, 3>> pieces;
  for (const auto& triangle : tree.triangles) {
    const Index piece = joined.root(triangle[0]);
    if (seen[piece]) continue;
    seen[piece] = true;
    const auto& vertex = tree.vertices[triangle[0]];
    pieces.push_back({vertex[0] + tree.origin[0], vertex[1] + tree.origin[1], vertex[2] + tree.origin[2]});
  }
  return pieces;
}

struct PlacedTree {
  const char* name;
  const runtime::PackedSphereTree& tree;
  runtime::Pose pose;
};

// If two surfaces do not touch, each connected piece of one is either wholly inside the other solid or wholly outside.
// So testing one vertex of each piece suffices.
void add_inside(json& inside, const PlacedTree& outer, const PlacedTree& inner) {
  if (outer.tree.triangles.empty()) return;
  const auto pieces = pieces_of(inner.tree);
  const auto within =
      static_cast<std::size_t>(std::count_if(pieces.begin(), pieces.end(), [&](const std::array<double, 3>& vertex) {
        return runtime::contains(outer.tree, outer.pose, transform(inner.pose, vertex));
      }));
  if (within == 0) return;
  inside.push_back({{"inner", inner.name}, {"outer", outer.name}, {"pieces", within}, {"of", pieces.size()}});
}

void print_inside(const json& inside) {
  for (const json& one : inside) {
    const auto pieces = one["pieces"].get<std::size_t>(), all = one["of"].get<std::size_t>();
    const auto inner = one["inner"].get<std::string>(), outer = one["outer"].get<std::string>();
    if (pieces == all) {
      fmt::print("{} lies inside {}: their surfaces do not touch, their solids overlap\n", inner, outer);
    } else {
      fmt::print("{} of the {} pieces of {} {} inside {}: the surfaces do not touch, the solids overlap\n", pieces, all,
                 inner, pieces == 1 ? "lies" : "lie", outer);
    }
  }
}

void print_contact(const runtime::Contact& contact, bool exact) {
  fmt::print("{} at ({:.6g}, {:.6g}, {:.6g})", exact ? "triangles meet" : "nearest spheres meet", contact.center[0],
             contact.center[1], contact.center[2]);
  if (exact) fmt::print(": triangle {} of a, {} of b", contact.triangle_a, contact.triangle_b);
  fmt::print("\n");
}

void print_pair_levels(const json& levels) {
  fmt::print("level  answer     pairs  sphere tests  triangle tests  separation at most  microseconds\n");
  for (const json& level : levels) {
    const json& bound = level["separation_bound"];
    fmt::print("{:>5}  {:6} {:9} {:13} {:15} {:>19} {:13.2f}\n", level["level"].get<std::string>(),
               level["answer"].get<std::string>(), level["pairs"].get<std::size_t>(),
               level["sphere_tests"].get<std::uint64_t>(), level["triangle_tests"].get<std::uint64_t>(),
               bound.is_null() ? std::string("-") : fmt::format("{:.6g}", bound.get<double>()),
               level["microseconds"].get<double>());
  }
}

}  // namespace

void collide(const CollideCommand& command) {
  check_input(command.a);
  check_input(command.b);
  const Provenance provenance = provenance_of(command.output.run, std::array{command.a, command.b});
  const runtime::PackedSphereTree a = load_tree(command.a), b = load_tree(command.b);
  const runtime::Pose pose_a = parse_pose(command.pose_a, "--pose-a"), pose_b = parse_pose(command.pose, "--pose");
  constexpr std::size_t room = 1u << 20;  // meeting pairs a level: plenty, 25 MB
  const runtime::PreparedTree body_a(a), body_b(b);
  runtime::NarrowPhase narrow(body_a, body_b, room);
  const json levels = run(narrow, pose_a, pose_b);
  json inside = json::array();
  if (narrow.answer() == Answer::no) {
    add_inside(inside, {"a", a, pose_a}, {"b", b, pose_b});
    add_inside(inside, {"b", b, pose_b}, {"a", a, pose_a});
  }
  if (command.output.json) {
    const json report{{"answer", answer_name(narrow.answer())},
                      {"inside", inside},
                      {"levels", levels},
                      {"provenance", to_json(provenance)}};
    fmt::print("{}\n", report.dump(2));
    return;
  }
  if (command.output.quiet) {
    fmt::print("{}\n", answer_name(narrow.answer()));
    return;
  }
  print_pair_levels(levels);
  if (narrow.answer() != Answer::no) print_contact(narrow.contact(), narrow.answer() == Answer::yes);
  print_inside(inside);
}

}  // namespace orchard::apps
