#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>

#include "io/polygons.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/random.h"
#include "read_bytes.h"
#include "support/effort.h"

// Polygons that no corner sees whole, and polygons around holes.
namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

struct Outline {
  std::vector<Point> places;
  std::vector<Index> corners;
};

double turn(const Point& a, const Point& b, const Point& c) { return (b - a).cross(c - a).z(); }

bool crosses(const Point& a, const Point& b, const Point& c, const Point& d) {
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

// Random places in the plane, in an order that crosses itself nowhere.
Outline random_outline(Random& random, std::size_t count) {
  Outline outline;
  for (std::size_t i = 0; i < count; ++i) {
    outline.places.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    outline.corners.push_back(static_cast<Index>(i));
  }
  const auto at = [&](std::size_t i) { return outline.places[outline.corners[i % count]]; };
  for (bool crossing = true; crossing;) {
    crossing = false;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = i + 2; k < count; ++k)
        if (crosses(at(i), at(i + 1), at(k), at(k + 1))) {
          std::reverse(outline.corners.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                       outline.corners.begin() + static_cast<std::ptrdiff_t>(k) + 1);
          crossing = true;
        }
  }
  return outline;
}

// A circle of corners at random distances from a centre.
std::vector<Point> ring(Random& random, const Point& center, double least, double most, bool clockwise) {
  const std::size_t count = 3 + random.below(9);
  std::vector<Point> places;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double radius = random.uniform(least, most);
    places.emplace_back(center + radius * Point(std::cos(angle), (clockwise ? -1 : 1) * std::sin(angle), 0));
  }
  return places;
}

// An outline with holes, each joined to what there is by an edge that is passed twice.
Outline keyhole(Random& random) {
  Outline outline;
  const auto add = [&](const std::vector<Point>& places) {
    std::vector<Index> loop;
    for (const Point& place : places) {
      loop.push_back(static_cast<Index>(outline.places.size()));
      outline.places.push_back(place);
    }
    return loop;
  };
  outline.corners = add(ring(random, {0, 0, 0}, 5, 8, false));
  std::vector<std::vector<Index>> holes;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      if (holes.empty() || random.below(2) == 0) holes.push_back(add(ring(random, {x, y, 0}, 0.2, 0.8, true)));
  for (std::size_t h = 0; h < holes.size(); ++h) {
    const auto is_free = [&](Index a, Index b) {
      const auto blocked = [&](const std::vector<Index>& loop) {
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const Index c = loop[i], d = loop[(i + 1) % loop.size()];
          if (a != c && a != d && b != c && b != d &&
              crosses(outline.places[a], outline.places[b], outline.places[c], outline.places[d]))
            return true;
        }
        return false;
      };
      return !blocked(outline.corners) &&
             std::none_of(holes.begin() + static_cast<std::ptrdiff_t>(h), holes.end(), blocked);
    };
    // The nearest corners that see each other, which the bridge passes no third one between.
    std::optional<std::array<std::size_t, 2>> bridge;
    double shortest = INFINITY;
    for (std::size_t i = 0; i < outline.corners.size(); ++i)
      for (std::size_t k = 0; k < holes[h].size(); ++k) {
        const double length = (outline.places[outline.corners[i]] - outline.places[holes[h][k]]).norm();
        if (length < shortest && is_free(outline.corners[i], holes[h][k])) bridge = {i, k}, shortest = length;
      }
    const auto [i, k] = *bridge;
    std::vector<Index> way(holes[h].begin() + static_cast<std::ptrdiff_t>(k), holes[h].end());
    way.insert(way.end(), holes[h].begin(), holes[h].begin() + static_cast<std::ptrdiff_t>(k) + 1);
    way.push_back(outline.corners[i]);
    outline.corners.insert(outline.corners.begin() + static_cast<std::ptrdiff_t>(i) + 1, way.begin(), way.end());
  }
  return outline;
}

Vector area_of(const Outline& outline) {
  Vector area = Vector::Zero();
  for (std::size_t i = 0; i < outline.corners.size(); ++i)
    area +=
        outline.places[outline.corners[i]].cross(outline.places[outline.corners[(i + 1) % outline.corners.size()]]) / 2;
  return area;
}

// Turns the plane, moves places off it by up to `depth`, and begins anywhere.
Outline placed(Outline outline, Random& random, double depth) {
  const Eigen::Quaterniond turned =
      Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
          .normalized();
  for (Point& place : outline.places) place = turned * (place + Point(0, 0, random.uniform(-depth, depth)));
  const auto count = static_cast<std::ptrdiff_t>(random.below(outline.corners.size()));
  std::rotate(outline.corners.begin(), outline.corners.begin() + count, outline.corners.end());
  if (random.below(2) == 0) std::reverse(outline.corners.begin(), outline.corners.end());
  return outline;
}

// The triangles turn as the outline does, cover its area once, and have its edges, each passed once, for their border.
void expect_filled(const Outline& outline, const std::string& what, double tolerance) {
  FaceCollector faces;
  faces.add(outline.corners);
  const FaceCollector::Split split = std::move(faces).finish(outline.places);
  EXPECT_EQ(split.overlapping, 0u) << what;
  EXPECT_EQ(split.triangles.size(), outline.corners.size() - 2) << what;
  const Vector area = area_of(outline), normal = area.normalized();
  double sum = 0, least = INFINITY;
  std::map<std::pair<Index, Index>, int> border;
  const auto pass = [&](Index from, Index to, int times) {
    border[{from, to}] += times;
    border[{to, from}] -= times;
  };
  for (const auto& t : split.triangles) {
    const Vector own = (outline.places[t[1]] - outline.places[t[0]]).cross(outline.places[t[2]] - outline.places[t[0]]);
    sum += own.dot(normal) / 2;
    least = std::min(least, own.dot(normal));
    for (std::size_t i = 0; i < 3; ++i) pass(t[i], t[(i + 1) % 3], 1);
  }
  for (std::size_t i = 0; i < outline.corners.size(); ++i)
    pass(outline.corners[i], outline.corners[(i + 1) % outline.corners.size()], -1);
  EXPECT_NEAR(sum, area.norm(), tolerance) << what;
  EXPECT_GE(least, -tolerance) << what;
  EXPECT_TRUE(std::ranges::all_of(border, [](const auto& edge) { return edge.second == 0; })) << what;
}

TEST(ConcavePolygons, AreFilledOnceWhateverTheirOutline) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 31);
    const Outline outline = random_outline(random, 4 + random.below(30));
    expect_filled(placed(outline, random, 0), "flat, seed " + std::to_string(seed), 1e-12);
  }
}

TEST(ConcavePolygons, AreFilledAroundHoles) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 32);
    const Outline outline = keyhole(random);
    expect_filled(placed(outline, random, 0), "flat, seed " + std::to_string(seed), 1e-10);
    expect_filled(placed(outline, random, 1e-4), "bent, seed " + std::to_string(seed), 1e-10);
  }
}

TEST(ConcavePolygons, ScaleExactlyByPowersOfTwo) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed, 33);
    const Outline outline = placed(keyhole(random), random, 1e-5);
    const auto split = [&](double scale) {
      std::vector<Point> places = outline.places;
      for (Point& place : places) place *= scale;
      FaceCollector faces;
      faces.add(outline.corners);
      return std::move(faces).finish(places).triangles;
    };
    for (const double scale : {0x1p-30, 0x1p40}) EXPECT_EQ(split(scale), split(1)) << seed;
  }
}

TEST(ConcavePolygons, KeepAnEdgeWholeThatACornerLiesOn) {
  // The notch reaches down to the lower side.
  const Outline outline{{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 4, 0}, {2, 0, 0}, {1, 4, 0}, {0, 4, 0}},
                        {0, 1, 2, 3, 4, 5, 6}};
  expect_filled(outline, "a notch through", 1e-12);
}

TEST(ConcavePolygons, MayRepeatACorner) {
  const std::vector<Point> places{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  FaceCollector faces;
  faces.add(std::vector<Index>{0, 1, 2, 2});
  faces.add(std::vector<Index>{2, 0, 0, 1, 2});
  const FaceCollector::Split split = std::move(faces).finish(places);
  EXPECT_EQ(split.triangles, (Triangles{{0, 1, 2}, {2, 0, 1}}));
  EXPECT_EQ(split.triangulated + split.overlapping, 0u);
}

// The faces of a prism over an outline, as text of the three formats; the outline's file lines come first.
std::string rows(const Outline& outline, Index first) {
  std::string text;
  const auto corner = [&](Index c) { text += " " + std::to_string(c + first); };
  const Index n = static_cast<Index>(outline.places.size());
  const auto start = [&](std::size_t count) { text += first == 1 ? "f" : std::to_string(count); };
  start(outline.corners.size());
  for (const Index c : outline.corners) corner(c + n);
  text += "\n";
  start(outline.corners.size());
  for (std::size_t i = outline.corners.size(); i-- > 0;) corner(outline.corners[i]);
  text += "\n";
  for (std::size_t i = 0; i < outline.corners.size(); ++i) {
    const Index a = outline.corners[i], b = outline.corners[(i + 1) % outline.corners.size()];
    start(4);
    for (const Index c : {a, b, b + n, a + n}) corner(c);
    text += "\n";
  }
  return text;
}

std::string places(const Outline& outline, const std::string& start) {
  std::string text;
  for (const double z : {0.0, 1.0})
    for (const Point& p : outline.places)
      text += start + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(z) + "\n";
  return text;
}

struct Files {
  std::string obj, ply, off;
};

Files prism_files(const Outline& outline) {
  const std::string vertices = std::to_string(2 * outline.places.size()),
                    faces = std::to_string(outline.corners.size() + 2);
  return {places(outline, "v ") + rows(outline, 1),
          "ply\nformat ascii 1.0\nelement vertex " + vertices +
              "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
              "\nproperty list uchar int vertex_indices\nend_header\n" + places(outline, "") + rows(outline, 0),
          "OFF\n" + vertices + " " + faces + " 0\n" + places(outline, "") + rows(outline, 0)};
}

TEST(ConcavePolygons, AreReadInEveryFormat) {
  const Outline u{{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},
                  {0, 1, 2, 3, 4, 5, 6, 7}};
  const Files files = prism_files(u);
  for (const TriangleMesh& mesh :
       {test::read_bytes(read_obj, files.obj, "u.obj"), test::read_bytes(read_ply, files.ply, "u.ply"),
        test::read_bytes(read_off, files.off, "u.off")}) {
    const MeshReport report = check_mesh(mesh);
    EXPECT_TRUE(report.solid()) << report.faults();
    EXPECT_DOUBLE_EQ(report.area, 30);
    EXPECT_DOUBLE_EQ(report.volume, 7);
  }
}

TEST(ConcavePolygons, SayWhereTheyCrossThemselves) {
  const std::vector<std::vector<Index>> crossing{{0, 2, 1, 3}, {0, 2, 1, 3, 4}, {0, 2, 4, 1, 3}, {0, 1, 2, 0, 1, 2}};
  Outline star;
  for (int i = 0; i < 5; ++i) star.places.emplace_back(std::cos(1.2566 * i), std::sin(1.2566 * i), 0);
  for (const auto& corners : crossing) {
    star.corners = corners;
    const Files files = prism_files(star);
    MeshReadReport obj, ply, off;
    read_obj(files.obj, "star.obj", obj);
    read_ply(files.ply, "star.ply", ply);
    read_off(files.off, "star.off", off);
    for (const MeshReadReport& report : {obj, ply, off}) {
      EXPECT_EQ(report.polygons_overlapping.count, 2u) << corners.size();
      EXPECT_FALSE(report.complete());
    }
    EXPECT_EQ(obj.polygons_overlapping.first, "line 11");
    EXPECT_EQ(ply.polygons_overlapping.first, "line 20");
    EXPECT_EQ(off.polygons_overlapping.first, "line 13");
  }
}

}  // namespace
}  // namespace orchard
