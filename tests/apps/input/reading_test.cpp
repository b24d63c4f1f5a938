#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

// What commands say of a file that is not read as it stands, and of corners that they join.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

std::string obj_text(const TriangleMesh& mesh) {
  std::string text;
  for (const Point& p : mesh.vertices) {
    text += "v";
    for (const double x : p) {
      char number[32];
      std::snprintf(number, sizeof number, " %.17g", x);
      text += number;
    }
    text += "\n";
  }
  for (const auto& t : mesh.triangles) {
    text += "f";
    for (const Index corner : t) text += " " + std::to_string(corner + 1);
    text += "\n";
  }
  return text;
}

// A ring of boxes in the middle of which a pin can stand, as a bag of triangles whose zeros are not quite zero.
TriangleMesh bored_block() {
  TriangleMesh mesh;
  constexpr Index kSides = 16;
  for (const double z : {0.0, 1.0})
    for (const double radius : {1.0, 2.5})
      for (Index i = 0; i < kSides; ++i) {
        const double angle = 2 * std::acos(-1.0) * i / kSides;
        mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
  const auto quad = [&](Index a, Index b, Index c, Index d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (Index i = 0; i < kSides; ++i) {
    const Index k = (i + 1) % kSides, out = kSides, up = 2 * kSides;
    quad(i, i + up, k + up, k);
    quad(out + i, out + k, out + k + up, out + i + up);
    quad(i + up, out + i + up, out + k + up, k + up);
    quad(i, k, out + k, out + i);
  }
  TriangleMesh bag = test::soup(mesh);
  for (std::size_t v = 0; v < bag.vertices.size(); ++v)
    for (double& x : bag.vertices[v])
      if (std::abs(x) < 1e-9) x = v % 2 == 0 ? 0 : -2.7e-16;
  return bag;
}

Finished run_on(const Workplace& here, const std::string& command, const std::string& mesh,
                const std::vector<std::string>& more) {
  std::vector<std::string> arguments{command};
  if (command == "verify") arguments.push_back((here / "out/m.orchard").string());
  arguments.push_back(mesh);
  if (command == "compare") arguments.push_back((here / "out/m.orchard").string());
  if (command == "build" || command == "sample" || command == "medial" || command == "voronoi")
    arguments.insert(arguments.end(), {"-o", (here / "out").string()});
  if (command == "build") arguments.insert(arguments.end(), {"--method", "octree", "--depth", "1"});
  if (command == "build" || command == "sample" || command == "medial") arguments.emplace_back("--no-views");
  if (command == "sample" || command == "medial" || command == "voronoi")
    arguments.insert(arguments.end(), {"--samples", "400"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return here.run(arguments);
}

constexpr std::array kCommands{"build", "medial", "sample", "voronoi", "verify", "compare", "inspect"};

TEST(Reading, SaysInEveryCommandWhatItSkipped) {
  const Workplace here;
  // The first vertex is no place, so that all others have the next number.
  TriangleMesh shape = test::l_shape();
  for (auto& t : shape.triangles)
    for (Index& corner : t) ++corner;
  const std::string mesh = here.add("m.obj", "v nan 0 0\n" + obj_text(shape) + "f 2 3\n");
  for (const char* command : kCommands) {
    const Finished said = run_on(here, command, mesh, {});
    ASSERT_EQ(said.exit_code, 0) << command << said.err;
    EXPECT_NE(said.out.find("skipped 1 face of fewer than three corners, at line 34"), std::string::npos)
        << command << said.out;
    EXPECT_NE(said.out.find("skipped 1 vertex with a coordinate that is not a finite number, at line 1"),
              std::string::npos)
        << command << said.out;
    const json reading = json::parse(run_on(here, command, mesh, {"--json"}).out)["reading"];
    EXPECT_EQ(reading["faces_skipped"]["count"], 1) << command;
    EXPECT_EQ(reading["vertices_skipped"]["first"], "line 1") << command;
    EXPECT_EQ(reading["lines"].size(), 2u) << command;
  }
  for (const char* command : {"build", "medial", "compare"}) {
    const Finished refused = run_on(here, command, mesh, {"--strict"});
    EXPECT_EQ(refused.exit_code, 2) << command;
    EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
    EXPECT_NE(refused.err.find("line 34"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("leave out --strict"), std::string::npos) << refused.err;
  }
}

TEST(Join, IsSaidByEveryCommand) {
  const Workplace here;
  const std::string mesh = here.add("m.obj", obj_text(bored_block()));
  for (const char* command : kCommands) {
    const Finished said = run_on(here, command, mesh, {});
    ASSERT_EQ(said.exit_code, 0) << command << said.err;
    EXPECT_EQ(said.out.find(": filled "), std::string::npos) << command << said.out;
    if (command != std::string("verify")) {
      EXPECT_NE(said.out.find(": joined "), std::string::npos) << command << said.out;
    }
    const json repair = json::parse(run_on(here, command, mesh, {"--json"}).out)["repair"];
    EXPECT_GT(repair["vertices_joined"], 0) << command;
    EXPECT_GT(repair["max_join_over_radius"].get<double>(), 1e-17) << command;
    EXPECT_LT(repair["max_join_over_radius"].get<double>(), 1e-15) << command;
    EXPECT_EQ(repair["holes_filled"], 0) << command;
    const Finished apart = run_on(here, command, mesh, {"--json", "--join", "0"});
    if (apart.exit_code == 0 && command != std::string("verify")) {
      EXPECT_EQ(json::parse(apart.out)["repair"]["vertices_joined"], 0) << command;
    }
  }
}

TEST(Join, LeavesRoomForAPinInABore) {
  const Workplace here;
  const std::string block = here.add("block.obj", obj_text(bored_block())),
                    pin = here.add("pin.obj", test::box({-0.3, -0.3, -1}, {0.3, 0.3, 2})),
                    out = (here / "out").string();
  for (const std::string& mesh : {block, pin}) ASSERT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 0);
  const Finished answer = here.run({"collide", out + "/block.orchard", out + "/pin.orchard", "--quiet"});
  EXPECT_EQ(answer.out, "no\n") << answer.err;
}

TEST(FillHoles, WarnsOfOneThatMovesTheSurfaceFar) {
  const Workplace here;
  // Without its cap.
  TriangleMesh ball = test::icosphere(3);
  std::erase_if(ball.triangles, [&](const std::array<Index, 3>& t) {
    return std::ranges::all_of(t, [&](Index v) { return ball.vertices[v].z() > 0.97; });
  });
  const std::string mesh = here.add("ball.obj", ball), out = (here / "out").string();
  for (const std::string mode : {"", "--quiet", "--json"}) {
    const Finished run = here.run(mode.empty() ? test::quick_build(mesh, out) : test::quick_build(mesh, out, {mode}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.err.starts_with("orchard: warning: " + mesh + ": filling a hole moved the surface by up to "))
        << run.err;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    if (mode == "--json") {
      EXPECT_TRUE(json::parse(run.out)["repair"]["warning"].is_string());
    }
  }
  EXPECT_NE(here.run({"inspect", mesh}).err.find("warning"), std::string::npos);
  // A tenth of a triangle is open.
  ball = test::icosphere(3);
  const auto [a, b, c] = ball.triangles.back();
  ball.triangles.pop_back();
  const Index n = static_cast<Index>(ball.vertices.size());
  const Point middle = (ball.vertices[a] + ball.vertices[b] + ball.vertices[c]) / 3;
  for (const Index corner : {a, b, c}) ball.vertices.push_back(middle + 0.1 * (ball.vertices[corner] - middle));
  for (const std::array<Index, 3>& t :
       {std::array{a, b, n + 1}, {a, n + 1, n}, {b, c, n + 2}, {b, n + 2, n + 1}, {c, a, n}, {c, n, n + 2}})
    ball.triangles.push_back(t);
  EXPECT_EQ(here.run(test::quick_build(here.add("whole.obj", ball), out)).err, "") << "it is a small one";
}

TEST(Voronoi, TakesPointsWithAHeader) {
  const Workplace here;
  std::string text = "x,y,z\n";
  for (const Point& p : test::icosphere(1).vertices)
    text += std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z()) + "\n";
  const Finished run = here.run({"voronoi", here.add("p.xyz", text)});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("skipped 1 line of header before the first point"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace orchard
