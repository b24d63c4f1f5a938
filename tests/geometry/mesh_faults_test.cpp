#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "expect_input_error.h"
#include "orchard/geometry/random.h"
#include "read_bytes.h"
#include "support/effort.h"

// Faces of fewer than three corners and vertices without finite coordinates: one of them is no reason to refuse a file.
namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

// A file in one of three formats of given vertices (as text) and faces.
struct Text {
  std::vector<std::string> vertices;
  std::vector<std::vector<Index>> faces;

  std::string obj() const {
    std::string text;
    for (const std::string& vertex : vertices) text += "v " + vertex + "\n";
    for (const auto& face : faces) text += "f" + corners(face, 1) + "\n";
    return text;
  }
  std::string ply() const {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices.size()) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n" + rows();
  }
  std::string off() const {
    return "OFF\n" + std::to_string(vertices.size()) + " " + std::to_string(faces.size()) + " 0\n" + rows();
  }

 private:
  static std::string corners(const std::vector<Index>& face, Index first) {
    std::string text;
    for (const Index corner : face) text += " " + std::to_string(corner + first);
    return text;
  }
  std::string rows() const {
    std::string text;
    for (const std::string& vertex : vertices) text += vertex + "\n";
    for (const auto& face : faces) text += std::to_string(face.size()) + corners(face, 0) + "\n";
    return text;
  }
};

struct FormatCase {
  const char* name;
  std::string text;
  TriangleMesh (*read)(std::string_view, const std::string&, MeshReadReport&);
};

std::vector<FormatCase> in_each_format(const Text& text) {
  return {{"mesh.obj", text.obj(), read_obj}, {"mesh.ply", text.ply(), read_ply}, {"mesh.off", text.off(), read_off}};
}

const std::vector<std::string> kCorners{"0 0 0", "1 0 0", "0 1 0", "0 0 1"};

TEST(MeshFaults, SkipsFacesOfFewerThanThreeCornersAndSaysWhere) {
  const Text text{kCorners, {{0, 1}, {0, 2, 1}, {3}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const char* first[] = {"line 5", "line 14", "line 7"};
  int format = 0;
  for (const auto& [name, file, read] : in_each_format(text)) {
    MeshReadReport report;
    EXPECT_EQ(read(file, name, report).triangles, (Triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})) << name;
    EXPECT_EQ(report.faces_skipped.count, 2u) << name;
    EXPECT_EQ(report.faces_skipped.first, first[format++]) << name;
    EXPECT_FALSE(report.complete()) << name;
  }
}

TEST(MeshFaults, SkipsVerticesThatAreNoPlaceIfNoFaceUsesThem) {
  for (const char* bad : {"nan 0 0", "0 -inf 0", "0 0 NaN", "1e999 0 0", "nan nan nan"}) {
    Text text{kCorners, {{0, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 0, 4}}};
    text.vertices.insert(text.vertices.begin() + 3, bad);
    for (const auto& [name, file, read] : in_each_format(text)) {
      MeshReadReport report;
      const TriangleMesh mesh = read(file, name, report);
      ASSERT_EQ(mesh.vertices.size(), 5u) << name;
      EXPECT_EQ(mesh.vertices[4], Point(0, 0, 1)) << name;
      EXPECT_LE(mesh.vertices[3].norm(), 1) << "in the way";
      EXPECT_EQ(report.vertices_skipped.count, 1u) << name;
      EXPECT_FALSE(report.complete()) << name;
    }
    text.faces.push_back({1, 0, 3});
    for (const auto& [name, file, read] : in_each_format(text)) {
      MeshReadReport report;
      test::expect_input_error([&, &file = file, read = read] { read(file, "mesh", report); },
                               {"mesh, line ", "finite number", "a face uses"});
    }
  }
}

TEST(MeshFaults, LeaveAllElseAsItIs) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 20 * test::more(); ++seed) {
    Random random(seed, 11);
    Text whole, faulty;
    const Index count = 4 + static_cast<Index>(random.below(20));
    std::vector<Index> number;  // in the faulty file
    for (Index v = 0; v < count; ++v) {
      for (; random.below(5) == 0; faulty.vertices.emplace_back("nan 0 inf")) {
      }
      number.push_back(static_cast<Index>(faulty.vertices.size()));
      std::string place;
      for (int i = 0; i < 3; ++i) place += std::to_string(random.uniform(-1, 1)) + " ";
      whole.vertices.push_back(place);
      faulty.vertices.push_back(place);
    }
    std::uint64_t skipped = 0;
    for (int f = 0; f < 12; ++f) {
      const Index a = static_cast<Index>(random.below(count - 2));
      whole.faces.push_back({a, a + 1, a + 2});
      for (; random.below(4) == 0; ++skipped)
        faulty.faces.push_back(random.below(2) == 0 ? std::vector<Index>{number[a]} : std::vector<Index>{number[a], 0});
      faulty.faces.push_back({number[a], number[a + 1], number[a + 2]});
    }
    const auto expected = in_each_format(whole), cases = in_each_format(faulty);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      MeshReadReport report, none;
      const TriangleMesh mesh = cases[i].read(cases[i].text, cases[i].name, report);
      const TriangleMesh right = expected[i].read(expected[i].text, expected[i].name, none);
      EXPECT_TRUE(none.complete());
      EXPECT_EQ(report.faces_skipped.count, skipped) << seed;
      ASSERT_EQ(mesh.triangles.size(), right.triangles.size()) << seed;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_EQ(mesh.vertices[mesh.triangles[t][k]], right.vertices[right.triangles[t][k]]) << seed;
    }
  }
}

TEST(MeshFaults, LeaveThePointsThatArePlaces) {
  MeshReadReport report;
  EXPECT_EQ(read_obj_or_points("v 0 0 0\nv nan 1 1\nv 1 2 3\n", "p.obj", report).vertices.size(), 2u);
  EXPECT_EQ(report.vertices_skipped.first, "line 2");
  EXPECT_EQ(read_xyz("0 0 0\n1 nan 0\n1 2 3\n", "p.xyz", report).vertices.size(), 2u);
  test::expect_input_error([] { test::read_bytes(read_obj_or_points, "v nan 0 0\n", "p.obj"); },
                           {"p.obj", "no vertices"});
}

TEST(ReadXyz, SkipsAHeader) {
  const std::vector<Point> points{{1, 2, 3}, {4, 5, 6}};
  for (const char* header : {"x y z\n", "X,Y,Z\n", "//X Y Z R G B\n", "\"x\";\"y\";\"z\"\n", "2\n", "2\nx y z\n",
                             "Point cloud 7\n", "x1 y1 z1 # columns\n", "2 points\n", "\n\nx\ty\tz\r\n"}) {
    MeshReadReport report;
    EXPECT_EQ(read_xyz(std::string(header) + "1 2 3\n4;5;6\n", "p.xyz", report).vertices, points) << header;
    EXPECT_GE(report.header_lines, 1u) << header;
    EXPECT_TRUE(report.complete()) << header;
    EXPECT_EQ(report.lines().size(), 1u) << header;
  }
  // What comes after points is none.
  test::expect_input_error([] { test::read_bytes(read_xyz, "1 2 3\nx y z\n", "p.xyz"); }, {"p.xyz, line 2", "\"x\""});
}

}  // namespace
}  // namespace orchard
