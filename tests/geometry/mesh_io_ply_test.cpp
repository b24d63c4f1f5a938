#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "expect_input_error.h"
#include "io/ply_header.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "random_ply.h"
#include "read_bytes.h"

namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

TriangleMesh read_ply_bytes(std::string_view bytes) { return test::read_bytes(read_ply, bytes, "mesh.ply"); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ReadPly, ReadsAnyTypesAndOrderInEveryEncoding) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::little_endian, PlyEncoding::big_endian}) {
      const test::RandomPly file(seed, encoding);
      const TriangleMesh mesh = read_ply_bytes(file.bytes());
      ASSERT_EQ(mesh.vertices, file.mesh().vertices) << "seed " << seed << "\n" << file.bytes().substr(0, 600);
      ASSERT_EQ(mesh.triangles, file.mesh().triangles) << "seed " << seed;
    }
  }
}

TEST(ReadPly, ReadsStripsOfTrianglesInEveryEncoding) {
  std::size_t triangles = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::little_endian, PlyEncoding::big_endian}) {
      const test::RandomPly file(seed, encoding, true);
      const TriangleMesh mesh = test::read_bytes(read_ply_or_points, file.bytes(), "mesh.ply");
      ASSERT_EQ(mesh.vertices, file.mesh().vertices) << "seed " << seed << "\n" << file.bytes().substr(0, 600);
      ASSERT_EQ(mesh.triangles, file.mesh().triangles) << "seed " << seed << "\n" << file.bytes();
      triangles += mesh.triangles.size();
    }
  }
  EXPECT_GT(triangles, 1000u);
}

TEST(ReadPly, TurnsStripsSoThatAllTrianglesFaceTheSameWay) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  // A tetrahedron in one strip.
  const TriangleMesh mesh = read_ply_bytes(text + "6 1 0 2 3 1 0\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{1, 0, 2}, {2, 0, 3}, {2, 3, 1}, {1, 3, 0}}));
  EXPECT_TRUE(check_mesh(mesh).solid()) << check_mesh(mesh).faults();
  // Three of its triangles in two strips.
  EXPECT_EQ(read_ply_bytes(text + "8 0 2 1 3 -1 2 0 3\n").triangles, (Triangles{{0, 2, 1}, {1, 2, 3}, {2, 0, 3}}));
}

TEST(ReadPly, ReadsAScanInStrips) {
  const std::filesystem::path file = std::filesystem::path(ORCHARD_SHARED_MODELS) / "dirty/igea.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the shared models are not here";
  const TriangleMesh mesh = read_mesh(file);
  EXPECT_EQ(mesh.vertices.size(), 134345u);
  EXPECT_EQ(mesh.triangles.size(), 268686u);
  const MeshReport report = check_mesh(mesh);
  EXPECT_TRUE(report.solid()) << report.faults();
  EXPECT_NEAR(report.volume, 0.00027852446, 1e-10);  // summed over the strips by another program
}

TEST(ReadPly, NamesTheLineOrByteOfAFaultInAStrip) {
  const auto text = [](const std::string& row) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n" +
           row;
  };
  EXPECT_EQ(read_ply_bytes(text("3 0 1 2\n")).triangles.size(), 1u);
  test::expect_input_error([&] { read_ply_bytes(text("3 0 1 3\n")); },
                           {"mesh.ply, line 13", "strip of triangles", "vertex 3"});
  test::expect_input_error([&] { read_ply_bytes(text("3 0 1 -2\n")); }, {"mesh.ply, line 13", "vertex -2"});
  test::expect_input_error([&] { read_ply_bytes(text("9 0 1 2\n")); }, {"mesh.ply, line 13", "9 items"});
  test::expect_input_error([&] { read_ply_bytes(text("2 0 1\n")); }, {"no faces"});
  test::expect_input_error([&] { read_ply_bytes(text("4 0 1 -1 2\n")); }, {"no faces"});
  test::expect_input_error([&] { read_ply_bytes(replaced(text("3 0 1 2\n"), "vertex_indices", "corners")); },
                           {"line 7", "no list"});
}

TEST(ReadPly, RefusesARandomFileCutShort) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const std::string bytes = test::RandomPly(seed, PlyEncoding::little_endian).bytes();
    const std::size_t size = Random(seed, 3).below(bytes.size());
    test::expect_input_error([&] { read_ply_bytes(std::string_view(bytes).substr(0, size)); }, {"mesh.ply"});
  }
}

std::string header(const std::string& encoding, const std::string& vertices = "3", const std::string& faces = "1") {
  return "ply\nformat " + encoding + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}
constexpr const char* kPoints = "0 0 0\n1 0 0\n0 1 0\n";

TEST(ReadPly, TakesEveryEndOfLineInTheHeader) {
  const std::string text = header("ascii") + kPoints + "3 0 1 2\n";
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string converted;
    for (const char c : text) converted += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(read_ply_bytes(converted).triangles, (Triangles{{0, 1, 2}}));
    // A binary body may begin with the byte that ends lines elsewhere.
    std::string binary;
    for (const char c : replaced(header("binary_big_endian"), "float x", "uchar x")) {
      binary += c == '\n' ? end : std::string(1, c);
    }
    test::PlyBody body(PlyEncoding::big_endian);
    for (int i = 0; i < 3; ++i) {
      body.put(PlyType::uint8, '\n');
      body.put(PlyType::float32, i);
      body.put(PlyType::float32, i * i);
    }
    body.put(PlyType::uint8, 3);
    for (const int i : {2, 1, 0}) body.put(PlyType::int32, i);
    const TriangleMesh mesh = read_ply_bytes(binary + body.bytes());
    EXPECT_EQ(mesh.vertices[0], Point(10, 0, 0));
    EXPECT_EQ(mesh.triangles, (Triangles{{2, 1, 0}}));
  }
}

TEST(ReadPly, ReadsAHeaderOfAHundredThousandElements) {
  std::string elements;
  for (int i = 0; i < 100000; ++i) ((elements += "element e") += std::to_string(i)) += " 0\n";
  const std::string text = header("ascii") + kPoints + "3 0 1 2\n";
  EXPECT_EQ(read_ply_bytes(replaced(text, "element vertex", elements + "element vertex")).triangles.size(), 1u);
}

TEST(ReadPly, TriangulatesPolygons) {
  EXPECT_EQ(read_ply_bytes(header("ascii", "4") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").triangles,
            (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ReadPly, NamesTheLineAndTheFaultOfAsciiFiles) {
  const std::string good = header("ascii") + kPoints + "3 0 1 2\n", three = header("ascii") + kPoints;
  EXPECT_NO_THROW(read_ply_bytes(good));
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"", {"not a PLY file"}},
      {"PLY\n", {"not a PLY file"}},
      {"ply", {"not a PLY file"}},
      {"ply\nformat ascii 1.0\n", {"line 3", "end_header"}},
      {replaced(good, "ascii", "text"), {"line 2", "expected \"format\""}},
      {replaced(good, "1.0", "2.0"), {"line 2", "expected \"format\""}},
      {replaced(good, "format ascii 1.0\n", ""), {"no \"format\" line"}},
      {replaced(good, "vertex 3", "vertex -3"), {"line 3", "\"-3\" is not a number of rows"}},
      {replaced(good, "vertex 3", "vertex 3.5"), {"line 3", "\"3.5\""}},
      {replaced(good, "vertex 3", "vertex 99999999999999999999"), {"line 3", "is not a number of rows"}},
      {replaced(good, "vertex 3", "vertex 1000000000000"), {"line 3", "promises 1000000000000 rows"}},
      {replaced(good, "face 1", "face 1000000000000"), {"line 7", "promises 1000000000000 rows"}},
      {replaced(good, "vertex 3", "vertex"), {"line 3", "expected \"element\""}},
      {replaced(good, "face 1", "vertex 1"), {"line 7", "declared twice"}},
      {replaced(good, "float x", "real x"), {"line 4", "unknown property type \"real\""}},
      {replaced(good, "property float x", "property float"), {"line 4", "expected \"property\""}},
      {replaced(good, "property float x", "prop float x"), {"line 4", "unknown keyword \"prop\""}},
      {replaced(good, "float y", "float w"), {"line 3", "no number \"y\""}},
      {replaced(good, "float y", "list uchar float y"), {"line 3", "no number \"y\""}},
      {replaced(good, "vertex_indices", "corners"), {"line 7", "no list \"vertex_indices\""}},
      {replaced(good, "list uchar int", "int"), {"line 7", "no list"}},
      {replaced(good, "element vertex", "property int early\nelement vertex"), {"line 3", "before the first element"}},
      {header("ascii") + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", {"line 11", "not a finite number"}},
      {header("ascii") + "0 0 0\n1 0 0\n0 1e999 0\n3 0 1 2\n", {"line 12", "not a finite number"}},
      {header("ascii") + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", {"line 11", "\"zero\" is not a number"}},
      {header("ascii") + "0 0 0\n1 0 0\n", {"line 12", "ends before the rows"}},
      {three, {"line 13", "ends before the rows"}},
      {three + "3 0 1", {"line 13", "ends before the rows"}},
      {three + "3 0 1 3\n", {"line 13", "vertex 3", "3 vertices"}},
      {three + "3 0 1 -1\n", {"line 13", "vertex -1"}},
      {three + "3 0 1 1.5\n", {"line 13", "not an integer"}},
      {three + "2 0 1\n", {"no faces"}},
      {three + "-3 0 1 2\n", {"line 13", "-3 items"}},
      {three + "9999 0 1 2\n", {"line 13", "9999 items"}},
      {header("ascii", "3", "0") + kPoints, {"no faces"}},
      {"ply\nformat ascii 1.0\nelement nothing 999999999999\nend_header\n", {"no faces"}},
  };
  for (const auto& [text, parts] : cases) {
    for (const std::string& part : parts)
      test::expect_input_error([&, &text = text] { read_ply_bytes(text); }, {"mesh.ply", part});
  }
}

TEST(ReadPly, NamesTheByteAndTheFaultOfBinaryFiles) {
  const std::string head = header("binary_little_endian");
  const auto file = [&](float coordinate, double length, double corner) {
    test::PlyBody body(PlyEncoding::little_endian);
    for (int i = 0; i < 9; ++i) body.put(PlyType::float32, i == 4 ? coordinate : static_cast<float>(i));
    body.put(PlyType::uint8, length);
    for (int i = 0; i < 3; ++i) body.put(PlyType::int32, i == 1 ? corner : 0);
    return head + body.bytes();
  };
  const auto byte = [&](std::size_t offset) { return "byte " + std::to_string(head.size() + offset); };
  const std::string good = file(1, 3, 1);
  EXPECT_NO_THROW(read_ply_bytes(good));
  test::expect_input_error([&] { read_ply_bytes(file(NAN, 3, 1)); }, {byte(16), "not a finite number"});
  test::expect_input_error([&] { read_ply_bytes(file(-INFINITY, 3, 1)); }, {byte(16), "not a finite number"});
  test::expect_input_error([&] { read_ply_bytes(file(1, 2, 1)); }, {"no faces"});
  test::expect_input_error([&] { read_ply_bytes(file(1, 4, 1)); }, {byte(36), "4 items"});
  test::expect_input_error([&] { read_ply_bytes(file(1, 3, 3)); }, {byte(41), "vertex 3"});
  test::expect_input_error([&] { read_ply_bytes(file(1, 3, -1)); }, {byte(41), "vertex -1"});
  test::expect_input_error([&] { read_ply_bytes(good.substr(0, good.size() - 1)); }, {byte(36), "3 items"});
  test::expect_input_error([&] { read_ply_bytes(good.substr(0, good.size() - 20)); }, {"line 3", "promises 3 rows"});
  test::expect_input_error([&] { read_ply_bytes(replaced(good, "vertex 3", "vertex 1000000000000")); },
                           {"promises 1000000000000"});
}

}  // namespace
}  // namespace orchard
