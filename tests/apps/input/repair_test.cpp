#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "program.h"
#include "support/shapes.h"

// What a repaired mesh is, where it goes, and how far it is from what was read.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// --- a judge that shares nothing with the library
// ----------------------------------------------------------------------

double to_segment(const Point& p, const Point& a, const Point& b) {
  const double length = (b - a).squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
  return (p - (a + t * (b - a))).norm();
}

double to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  double distance = std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
  const Vector normal = (b - a).cross(c - a);
  if (!(normal.squaredNorm() > 0)) return distance;
  const auto inside = [&](const Point& x, const Point& y) { return normal.dot((y - x).cross(p - x)) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a))
    distance = std::min(distance, std::abs(normal.dot(p - a)) / normal.norm());
  return distance;
}

double to_mesh(const Point& p, const TriangleMesh& mesh) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    nearest = std::min(nearest, to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  return nearest;
}

// The largest distance from points of one mesh to the other: of a grid on each triangle, whose points are `spacing`
// apart at most.
struct Sampled {
  double distance = 0, spacing = 0;
};

Sampled sampled_distance(const TriangleMesh& from, const TriangleMesh& to) {
  constexpr int kSteps = 6;
  Sampled result;
  for (const auto& [a, b, c] : from.triangles) {
    const Point &p = from.vertices[a], &q = from.vertices[b], &r = from.vertices[c];
    result.spacing =
        std::max({result.spacing, (p - q).norm() / kSteps, (q - r).norm() / kSteps, (r - p).norm() / kSteps});
    for (int i = 0; i <= kSteps; ++i)
      for (int k = 0; i + k <= kSteps; ++k)
        result.distance = std::max(result.distance, to_mesh(p + (q - p) * i / kSteps + (r - p) * k / kSteps, to));
  }
  return result;
}

// --- broken meshes
// -----------------------------------------------------------------------------------------------------

// A vertex in the middle of an edge of one of its two triangles, and the triangle without area between them.
void add_sliver(TriangleMesh& mesh, std::size_t triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  const auto middle = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
  mesh.triangles[triangle] = {a, middle, c};
  mesh.triangles.push_back({middle, b, c});
  mesh.triangles.push_back({a, b, middle});
}

TriangleMesh broken(std::uint64_t seed) {
  Random random(seed, 7);
  TriangleMesh mesh;
  switch (random.below(6)) {
    case 0:
      mesh = test::icosphere(2);
      break;
    case 1:
      mesh = test::torus(14, 9);
      break;
    case 2:
      mesh = test::l_shape();
      break;
    case 3:
      mesh = test::u_shape(0.3);
      break;
    case 4:
      mesh = test::two_boxes(0.4);
      break;
    default:
      mesh = test::box({0, 0, 0}, {1, 2, 3});
      break;
  }
  const double size = std::pow(10.0, random.uniform(-3, 3));
  for (Point& p : mesh.vertices)
    p += Point(random.uniform(-.02, .02), random.uniform(-.02, .02), random.uniform(-.02, .02));
  mesh = test::transformed(std::move(mesh), size, size * Vector(random.uniform(-9, 9), random.uniform(-9, 9), 0));
  const auto any = [&] { return static_cast<std::size_t>(random.below(mesh.triangles.size())); };
  if (random.below(2) == 0) {  // holes, some of several triangles
    for (std::uint64_t i = 0, count = 1 + random.below(4); i < count && mesh.triangles.size() > 8; ++i)
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(any()));
  }
  if (random.below(3) == 0) add_sliver(mesh, any());
  if (random.below(3) == 0) std::swap(mesh.triangles[any()][0], mesh.triangles[0][1]);  // may leave nonsense
  if (random.below(3) == 0) {
    auto& turned = mesh.triangles[any()];
    std::swap(turned[0], turned[1]);
  }
  if (random.below(3) == 0) mesh.triangles.push_back(mesh.triangles[any()]);
  if (random.below(4) == 0) mesh = test::mirrored(std::move(mesh));
  if (random.below(4) == 0)
    mesh = test::joined({mesh, test::transformed(test::icosphere(1), 0.01 * size, size * Vector(30, 0, 0))});
  if (random.below(3) == 0) mesh = test::soup(mesh);
  return mesh;
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

// CI's seeds; more with ORCHARD_REPAIR_SEEDS=first,count.
std::pair<std::uint64_t, std::uint64_t> seeds() {
  const char* text = std::getenv("ORCHARD_REPAIR_SEEDS");
  if (text == nullptr) return {1, 12};
  char* end = nullptr;
  const std::uint64_t first = std::strtoull(text, &end, 10);
  return {first, std::strtoull(end + 1, nullptr, 10)};
}

TEST(Repair, IsWrittenBesideTheTreeAndBoundedByDistancesThatHold) {
  const auto [first, count] = seeds();
  std::uint64_t repaired = 0, moved = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE(seed);
    const Workplace here;
    const TriangleMesh input = broken(seed);
    const std::string mesh = here.add("m.obj", input), out = (here / "out").string();
    const Finished run =
        here.run({"build", mesh, "-o", out, "--method", "octree", "--depth", "1", "--no-views", "--json"});
    if (run.exit_code == 2) continue;  // beyond repair
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json report = json::parse(run.out), &repair = report["repair"];
    const bool changed = !repair["lines"].empty();
    EXPECT_EQ(report["certified_mesh"], changed ? json("m-repaired.obj") : json());
    ASSERT_EQ(here.files("out").contains("m-repaired.obj"), changed);
    const TriangleMesh solid = changed ? read_mesh(here / "out/m-repaired.obj") : input;
    EXPECT_TRUE(check_mesh(solid).solid());
    EXPECT_EQ(solid.triangles.size(), report["mesh"]["triangles"].get<std::size_t>());
    EXPECT_EQ(here.run({"verify", out + "/m.orchard", changed ? out + "/m-repaired.obj" : mesh, "--quiet"}).exit_code,
              0);
    if (!changed) continue;
    ++repaired;
    const double radius = report["mesh"]["bounding_ball"][3];
    double max = 0;
    for (const auto& [key, from, to] :
         {std::tuple{"repaired_to_input", &solid, &input}, {"input_to_repaired", &input, &solid}}) {
      const double lower = repair[key][0], upper = repair[key][1];
      const Sampled judged = sampled_distance(*from, *to);
      EXPECT_LE(judged.distance, upper + 1e-12 * radius) << key;
      EXPECT_GE(judged.distance + judged.spacing, lower) << key;
      EXPECT_LE(upper - lower, 1e-4 * radius) << key;
      max = std::max(max, upper);
    }
    moved += max > 1e-3 * radius ? 1 : 0;
    EXPECT_EQ(repair["distance"].get<double>(), max);
    EXPECT_DOUBLE_EQ(repair["distance_over_radius"].get<double>(), max / radius);
    const Finished inspected = here.run({"inspect", mesh, "--json"});
    const json seen = json::parse(inspected.out)["repair"];
    for (const char* key : {"repaired_to_input", "input_to_repaired", "distance", "lines"})
      EXPECT_EQ(seen[key], repair[key]) << key;
  }
  EXPECT_GT(repaired, count / 4);
  EXPECT_GT(moved, count / 20);
}

// One triangle of a ball: the fill is the same triangle, and its farthest point is the middle of its incircle.
TEST(Repair, OfAHoleIsAsFarFromTheInputAsTheFillReaches) {
  const Workplace here;
  TriangleMesh mesh = test::icosphere(2);
  const auto [i, k, l] = mesh.triangles[17];
  const Vector a = mesh.vertices[k] - mesh.vertices[i], b = mesh.vertices[l] - mesh.vertices[i];
  const double in_radius = a.cross(b).norm() / (a.norm() + b.norm() + (a - b).norm());
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  const std::string file = here.add("ball.obj", mesh);
  const Finished run =
      here.run({"build", file, "-o", (here / "out").string(), "--method", "octree", "--depth", "1", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json repair = json::parse(here.files("out").at("ball.json"))["repair"];
  EXPECT_LE(repair["repaired_to_input"][0].get<double>(), in_radius * (1 + 1e-12));
  EXPECT_GE(repair["repaired_to_input"][1].get<double>(), in_radius * (1 - 1e-12));
  EXPECT_NEAR(repair["repaired_to_input"][0].get<double>(), in_radius, 2e-6);
  EXPECT_EQ(repair["input_to_repaired"][1].get<double>(), 0);
  EXPECT_NE(run.out.find(file + ": repaired: no point of it is farther than "), std::string::npos) << run.out;
  const std::string last = run.out.substr(run.out.rfind('\n', run.out.size() - 2) + 1);
  EXPECT_NE(last.find("conservative: every point of the repaired mesh, "), std::string::npos) << last;
  EXPECT_NE(last.find("ball-repaired.obj"), std::string::npos) << last;
  const Finished inspected = here.run({"inspect", file});
  EXPECT_NE(inspected.out.find("repair makes a solid of it: no point of it is farther than "), std::string::npos);
  const Finished verified = here.run({"verify", (here / "out/ball.orchard").string(), file});
  EXPECT_EQ(verified.exit_code, 0);
  EXPECT_NE(verified.out.find("against the repaired mesh: no point of it is farther than "), std::string::npos);
}

TEST(Repair, ThatOnlyTurnsAndWeldsMovesNothing) {
  const Workplace here;
  // Its cavity faces outward.
  const TriangleMesh hollow = test::joined({test::box({0, 0, 0}, {4, 4, 4}), test::box({1, 1, 1}, {2, 2, 2})});
  for (const auto& [name, mesh] : {std::pair{"soup.obj", test::soup(test::l_shape())},
                                   {"turned.obj", test::mirrored(test::torus(12, 8))},
                                   {"hollow.obj", hollow}}) {
    const Finished run = here.run({"build", here.add(name, mesh), "-o", (here / "out").string(), "--method", "octree",
                                   "--depth", "1", "--no-views", "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json repair = json::parse(run.out)["repair"];
    EXPECT_FALSE(repair["lines"].empty()) << name;
    EXPECT_EQ(repair["distance"].get<double>(), 0) << name;
  }
  EXPECT_FALSE(same(read_mesh(here / "out/hollow-repaired.obj"), hollow));
}

TEST(Repair, OfASolidIsNotWritten) {
  const Workplace here;
  const Finished run = here.run({"build", here.add("l.obj", test::l_shape()), "-o", (here / "out").string(), "--method",
                                 "octree", "--depth", "1", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_FALSE(here.files("out").contains("l-repaired.obj"));
  EXPECT_EQ(json::parse(here.files("out").at("l.json"))["repair"]["distance"].get<double>(), 0);
  EXPECT_NE(run.out.find("conservative: every point of the surface is certified"), std::string::npos);
}

// A ball without its cap, down to this height.
TriangleMesh open_ball(double height) {
  TriangleMesh mesh = test::icosphere(4);
  std::erase_if(mesh.triangles, [&](const std::array<Index, 3>& t) {
    return std::ranges::all_of(t, [&](Index v) { return mesh.vertices[v].z() > height; });
  });
  return mesh;
}

TEST(FillHoles, NamesTheLimitAndTheWayOut) {
  const Workplace here;
  const std::string mesh = here.add("open.obj", open_ball(0.5)), out = (here / "out").string();
  const Finished refused = here.run(test::quick_build(mesh, out));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
  for (const char* part : {"1 hole left open", "bounding radii across", "wider than 0.5 or of more than 100 edges"})
    EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err;
  // What it says to do does it.
  const std::size_t at = refused.err.find("--fill-holes ");
  ASSERT_NE(at, std::string::npos) << refused.err;
  const std::string size = refused.err.substr(at + 13, refused.err.find(' ', at + 13) - at - 13);
  const Finished filled = here.run(test::quick_build(mesh, out, {"--fill-holes", size}));
  EXPECT_EQ(filled.exit_code, 0) << filled.err;
  EXPECT_NE(filled.out.find("filled 1 hole"), std::string::npos) << filled.out;
  const Finished inspected = here.run({"inspect", mesh});
  EXPECT_NE(inspected.out.find("--fill-holes " + size), std::string::npos) << inspected.out;
}

TEST(FillHoles, LeavesOpenWhatIsWider) {
  const Workplace here;
  const std::string mesh = here.add("open.obj", open_ball(0.95)), out = (here / "out").string();
  EXPECT_EQ(here.run(test::quick_build(mesh, out)).exit_code, 2) << "it is 0.6 wide";
  EXPECT_EQ(here.run(test::quick_build(mesh, out, {"--fill-holes", "0.3"})).exit_code, 2);
  EXPECT_EQ(here.run(test::quick_build(mesh, out, {"--fill-holes", "0.9"})).exit_code, 0);
}

}  // namespace
}  // namespace orchard
