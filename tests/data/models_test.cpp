// The bundled models are what data/README.md promises: clean solids of a known size.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>
#include <map>
#include <numeric>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double kMinAngleDegrees = 2.0;
constexpr double kCountTolerance = 0.15;
// Neighbours in a flat side are coplanar within the first value; nothing that is meant as an edge
// comes near it.
constexpr double kCoplanar = 1e-5;
constexpr double kClearlyBent = 1e-2;

using Point = std::array<double, 3>;
using Triangle = std::array<std::size_t, 3>;
using Edge = std::pair<std::size_t, std::size_t>;

struct Model {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
};

Model read_model(const std::string& name) {
  std::ifstream in(std::string(ORCHARD_DATA_DIR) + "/" + name + ".obj");
  Model model;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      Point& p = model.points.emplace_back();
      words >> p[0] >> p[1] >> p[2];
    } else if (key == "f") {
      Triangle& t = model.triangles.emplace_back();
      words >> t[0] >> t[1] >> t[2];
      for (std::size_t& i : t) --i;
    }
    EXPECT_FALSE(words.fail()) << line;
  }
  return model;
}

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double angle_between(const Point& a, const Point& b) {
  const Point c = cross(a, b);
  return std::atan2(std::sqrt(dot(c, c)), dot(a, b));
}

Point normal_of(const Model& model, const Triangle& t) {
  const Point& a = model.points[t[0]];
  return cross(model.points[t[1]] - a, model.points[t[2]] - a);
}

/// The triangle to the left of every directed edge.
std::map<Edge, std::size_t> directed_edges(const Model& model) {
  std::map<Edge, std::size_t> edges;
  for (std::size_t f = 0; f < model.triangles.size(); ++f) {
    const Triangle& t = model.triangles[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_new = edges.insert({{t[i], t[(i + 1) % 3]}, f}).second;
      EXPECT_TRUE(is_new) << "edge used twice in one direction: " << t[i] << " " << t[(i + 1) % 3];
    }
  }
  return edges;
}

std::size_t count_groups(std::size_t count, const std::vector<Edge>& links) {
  std::vector<std::size_t> parent(count);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [a, b] : links) parent[root(a)] = root(b);
  std::size_t groups = 0;
  for (std::size_t i = 0; i < count; ++i) groups += root(i) == i ? 1 : 0;
  return groups;
}

/// Whether the segment passes through the inside of the triangle.
bool pierces(const Point& from, const Point& to, const std::array<Point, 3>& t) {
  const Point normal = cross(t[1] - t[0], t[2] - t[0]);
  if (dot(normal, from - t[0]) * dot(normal, to - t[0]) >= 0.0) return false;
  const Point way = to - from;
  std::array<double, 3> turns{};
  for (std::size_t i = 0; i < 3; ++i) {
    turns[i] = dot(way, cross(t[i] - from, t[(i + 1) % 3] - from));
  }
  return std::all_of(turns.begin(), turns.end(), [](double v) { return v > 0.0; }) ||
         std::all_of(turns.begin(), turns.end(), [](double v) { return v < 0.0; });
}

struct Expectation {
  std::string name;
  double triangles;
  Point size;
  std::size_t genus;
};

void PrintTo(const Expectation& expectation, std::ostream* out) { *out << expectation.name; }

class BundledModel : public testing::TestWithParam<Expectation> {
 protected:
  Model model_ = read_model(GetParam().name);
};

TEST_P(BundledModel, HasTheExpectedNumberOfTriangles) {
  const double count = static_cast<double>(model_.triangles.size());
  EXPECT_NEAR(count, GetParam().triangles, kCountTolerance * GetParam().triangles);
}

TEST_P(BundledModel, HasTheExpectedSize) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax_element(model_.points.begin(), model_.points.end(),
                                                 [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    EXPECT_NEAR((*high)[axis] - (*low)[axis], GetParam().size[axis], 0.1) << "axis " << axis;
  }
}

TEST_P(BundledModel, IsClosedAndConsistentlyOriented) {
  ASSERT_FALSE(model_.triangles.empty());
  const std::map<Edge, std::size_t> edges = directed_edges(model_);
  for (const auto& [edge, face] : edges) {
    EXPECT_TRUE(edges.contains({edge.second, edge.first})) << "open edge of face " << face;
  }
}

TEST_P(BundledModel, HasTheExpectedGenus) {
  // For closed triangle meshes F = 2 V - 4 + 4 g.
  EXPECT_EQ(model_.triangles.size() + 4, 2 * model_.points.size() + 4 * GetParam().genus);
}

TEST_P(BundledModel, EveryVertexHasOneFan) {
  const std::map<Edge, std::size_t> edges = directed_edges(model_);
  std::vector<std::size_t> corners(model_.points.size());
  for (const Triangle& t : model_.triangles) {
    for (const std::size_t i : t) ++corners.at(i);
  }
  std::vector<bool> seen(model_.points.size());
  for (const auto& [edge, face] : edges) {
    const std::size_t centre = edge.first;
    if (seen[centre]) continue;
    seen[centre] = true;
    // Walk once around the vertex: the walk must meet all of its triangles.
    std::size_t steps = 0;
    std::size_t current = face;
    do {
      const Triangle& t = model_.triangles[current];
      const std::size_t at = static_cast<std::size_t>(std::find(t.begin(), t.end(), centre) - t.begin());
      current = edges.at({centre, t[(at + 2) % 3]});
      ++steps;
    } while (current != face && steps <= corners[centre]);
    EXPECT_EQ(steps, corners[centre]) << "vertex " << centre;
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), std::identity{})) << "unused vertex";
}

TEST_P(BundledModel, HasOneComponentAndPositiveVolume) {
  std::vector<Edge> links;
  double volume = 0.0;
  for (const Triangle& t : model_.triangles) {
    links.insert(links.end(), {{t[0], t[1]}, {t[1], t[2]}});
    volume += dot(model_.points[t[0]], cross(model_.points[t[1]], model_.points[t[2]])) / 6.0;
  }
  EXPECT_EQ(count_groups(model_.points.size(), links), 1U);
  EXPECT_GT(volume, 0.0);
}

TEST_P(BundledModel, HasNoDuplicatePointsAndNoThinTriangles) {
  EXPECT_EQ(std::set<Point>(model_.points.begin(), model_.points.end()).size(), model_.points.size());
  for (const Triangle& t : model_.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& p = model_.points[t[i]];
      const double angle = angle_between(model_.points[t[(i + 1) % 3]] - p, model_.points[t[(i + 2) % 3]] - p);
      EXPECT_GT(angle * 180.0 / std::acos(-1.0), kMinAngleDegrees) << t[0] << " " << t[1] << " " << t[2];
    }
  }
}

TEST_P(BundledModel, NeighboursAreCoplanarOrClearlyBent) {
  const std::map<Edge, std::size_t> edges = directed_edges(model_);
  std::size_t coplanar = 0;
  for (const auto& [edge, face] : edges) {
    const std::size_t other = edges.at({edge.second, edge.first});
    const double bend =
        angle_between(normal_of(model_, model_.triangles[face]), normal_of(model_, model_.triangles[other]));
    EXPECT_TRUE(bend < kCoplanar || bend > kClearlyBent) << bend;
    coplanar += bend < kCoplanar ? 1 : 0;
  }
  EXPECT_GT(coplanar, edges.size() / 4);
}

TEST_P(BundledModel, DoesNotCutItself) {
  std::vector<std::array<Point, 3>> corners;
  for (const Triangle& t : model_.triangles) {
    corners.push_back({model_.points[t[0]], model_.points[t[1]], model_.points[t[2]]});
  }
  for (const auto& [edge, face] : directed_edges(model_)) {
    const auto& [a, b] = edge;
    if (a > b) continue;
    for (std::size_t f = 0; f < corners.size(); ++f) {
      const Triangle& t = model_.triangles[f];
      // An edge that starts at a corner of the triangle meets its plane there only.
      if (std::count(t.begin(), t.end(), a) + std::count(t.begin(), t.end(), b) > 0) continue;
      EXPECT_FALSE(pierces(model_.points[a], model_.points[b], corners[f]))
          << "edge " << a << " " << b << " of face " << face << ", face " << f;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Data, BundledModel,
                         testing::Values(Expectation{"lamp", 626.0, {3.15, 3.05, 1.9}, 2},
                                         Expectation{"faucet", 1288.0, {5.8, 4.1, 10.0}, 0},
                                         Expectation{"ship", 1420.0, {3.1, 2.8, 3.5}, 0}),
                         [](const auto& model) { return model.param.name; });

}  // namespace
