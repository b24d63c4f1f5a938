#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "expect_input_error.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/random.h"
#include "read_bytes.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

std::string ascii_stl(const TriangleMesh& mesh, const std::string& name, const std::string& end) {
  std::string text = "solid " + name + end;
  for (const auto& corners : mesh.triangles) {
    text += "  facet normal 0 0 0" + end + "    outer loop" + end;
    for (const Index corner : corners) {
      text += "      vertex";
      for (const double x : mesh.vertices[corner]) (text += ' ') += std::to_string(x);
      text += end;
    }
    text += "    endloop" + end + "  endfacet" + end;
  }
  return text + "endsolid " + name + end;
}

std::string binary_stl(const TriangleMesh& mesh, const std::string& start) {
  std::string bytes = start + std::string(80 - start.size(), ' ');
  const auto put = [&](const auto& value) {
    std::string raw(sizeof value, '\0');
    std::memcpy(raw.data(), &value, sizeof value);
    bytes += raw;
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& corners : mesh.triangles) {
    bytes += std::string(12, '\0');
    for (const Index corner : corners) {
      for (const double x : mesh.vertices[corner]) put(static_cast<float>(x));
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

TEST(ReadStl, WeldsIdenticalCornersInBothEncodings) {
  const TriangleMesh shapes[] = {test::l_shape(), test::u_shape(0.5), test::box(Point(0, 0, 0), Point(1, 2, 3))};
  for (const TriangleMesh& shape : shapes) {
    const std::string files[] = {
        ascii_stl(shape, "part", "\n"),         ascii_stl(shape, "", "\r\n"),
        ascii_stl(shape, "a solid part", "\n"), ascii_stl(shape, "facet", "\r"),
        binary_stl(shape, "made by hand"),      binary_stl(shape, "solid binary"),
        binary_stl(shape, "solid\n"),           binary_stl(shape, "made by hand") + "more",
    };
    for (const std::string& file : files) {
      const TriangleMesh mesh = test::read_bytes(read_stl, file, "mesh.stl");
      const MeshReport report = check_mesh(mesh), expected = check_mesh(shape);
      EXPECT_EQ(mesh.vertices.size(), shape.vertices.size());
      EXPECT_EQ(mesh.triangles.size(), shape.triangles.size());
      EXPECT_TRUE(report.solid()) << report.faults();
      EXPECT_DOUBLE_EQ(report.volume, expected.volume);
    }
  }
}

TEST(ReadStl, JoinsTheSolidsOfOneFile) {
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(1, 1, 1)),
                     other = test::transformed(box, 1, Vector(3, 0, 0));
  const TriangleMesh mesh =
      test::read_bytes(read_stl, ascii_stl(box, "one", "\n") + ascii_stl(other, "two", "\n"), "mesh.stl");
  EXPECT_EQ(mesh.vertices.size(), 16u);
  EXPECT_DOUBLE_EQ(check_mesh(mesh).volume, 2);
}

TEST(ReadStl, NamesTheLineOrByteAndTheFault) {
  const std::string good = ascii_stl(test::l_shape(), "part", "\n"), binary = binary_stl(test::l_shape(), "binary");
  const auto replaced = [&](const std::string& from, const std::string& to) {
    return std::string(good).replace(good.find(from), from.size(), to);
  };
  std::string promise = binary, infinite = binary;
  promise[83] = '\x7f';
  const float infinity = INFINITY;
  std::memcpy(infinite.data() + 96 + 4, &infinity, 4);
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"", {"84 bytes"}},
      {"hello", {"84 bytes"}},
      {"solid", {"endsolid"}},
      {"solid\nendsolid\n", {"no faces"}},
      {good.substr(0, good.size() / 2), {"mesh.stl"}},
      {good.substr(0, good.rfind("endsolid")), {"without \"endsolid\""}},
      {replaced("endloop", "vertex 1 2 3\nendloop"), {"line 7", "expected \"endloop\"", "triangles"}},
      {replaced("outer loop", "inner loop"), {"line 3", "\"inner\""}},
      {replaced("vertex", "vertex one"), {"line 4", "three finite numbers"}},
      {replaced("vertex", "vertex nan"), {"line 4", "three finite numbers"}},
      {replaced("vertex", "vertex 1e999"), {"line 4", "three finite numbers"}},
      {replaced("endfacet", "endfacet\nnonsense"), {"line 9", "\"nonsense\""}},
      {binary.substr(0, 83), {"84 bytes"}},
      {binary.substr(0, binary.size() - 1), {"byte 80", "promises 20 triangles"}},
      {promise, {"byte 80", "promises 2130706452 triangles"}},
      {infinite, {"byte 100", "not a finite number"}},
      {std::string(1000, '\xff'), {"byte 80", "promises 4294967295"}},
  };
  for (const auto& [text, parts] : cases) {
    for (const std::string& part : parts) {
      test::expect_input_error([&bytes = text] { test::read_bytes(read_stl, bytes, "mesh.stl"); }, {"mesh.stl", part});
    }
  }
}

TEST(ReadOff, TakesEveryHeaderAndSkipsColours) {
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const std::string files[] = {
      "OFF\n4 1 0\n" + points + "4 0 1 2 3\n",
      "OFF 4 1 0\n" + points + "4 0 1 2 3",
      "# comment\nOFF # comment\n\n4 1\n# comment\n" + points + "\n4 0 1 2 3 255 0 0\n",
      "OFF\r\n4 1 0\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3\r\n",
      "OFF\r4 1 0\r0 0 0\r1 0 0\r1 1 0\r0 1 0\r4 0 1 2 3\r",
      "COFF\n4 1 0\n0 0 0 1 0 0 1\n1 0 0 0.5\n1 1 0\n0 1 0 255 255 255\n4 0 1 2 3\n",
      "NOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n",
      "STCNOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\nleft over\n",
      "OFF\n4 1 0\n\t0 +0 0e0\n1. 0 0\n 1 1 0\n0 1 0 # here\n\t4 0 1 2 3\n",
      "OFF4 1 0\n" + points + "4 0 1 2 3\n",
      "COFF4 1 0\n" + points + "4 0 1 2 3\n",
      "4 1 0\n" + points + "4 0 1 2 3\n",
      "\xef\xbb\xbfOFF\n4 1 0\n" + points + "4 0 1 2 3\n",
      "OFF\n4 1 0\n" + points + "4\n0 1\n\n2 # two\n# three\n3 255 0 0\n",
      "OFF\r\n4 1 0\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1\r\n2 3",
  };
  for (const std::string& file : files) {
    const TriangleMesh mesh = test::read_bytes(read_off, file, "mesh.off");
    EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})) << file;
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}})) << file;
  }
}

// Polygons of a convex outline, their corners broken into lines at random.
TEST(ReadOff, ReadsFacesOverAnyNumberOfLines) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 1);
    std::string points, whole, broken;
    const Index vertices = 3 + static_cast<Index>(random.below(40)), faces = 1 + static_cast<Index>(random.below(9));
    for (Index i = 0; i < vertices; ++i) {
      const double angle = 6.28 * i / vertices;
      points += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    }
    for (Index i = 0; i < faces; ++i) {
      const Index corners = 3 + static_cast<Index>(random.below(vertices - 2));
      const Index first = static_cast<Index>(random.below(vertices));
      whole += std::to_string(corners);
      broken += std::to_string(corners);
      for (Index j = 0; j < corners; ++j) {
        static constexpr std::array kGaps{" ", "\n", "\r\n  ", " # comment\n", "\n\n\t", "\t"};
        const std::string corner = std::to_string((first + j) % vertices);
        whole += " " + corner;
        broken += kGaps.at(random.below(kGaps.size())) + corner;
      }
      const std::string colour = random.below(2) == 0 ? "" : " 0.5 0.5 1";
      whole += colour + "\n";
      broken += colour + "\n";
    }
    const std::string start = "OFF\n" + std::to_string(vertices) + " " + std::to_string(faces) + " 0\n" + points;
    const TriangleMesh expected = test::read_bytes(read_off, start + whole, "mesh.off"),
                       mesh = test::read_bytes(read_off, start + broken, "mesh.off");
    ASSERT_EQ(mesh.vertices, expected.vertices) << "seed " << seed;
    ASSERT_EQ(mesh.triangles, expected.triangles) << "seed " << seed << "\n" << broken;
  }
}

TEST(ReadOff, NamesTheLineAndTheFault) {
  const std::string start = "OFF\n3 1 0\n", points = "0 0 0\n1 0 0\n0 1 0\n";
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"", {"not an OFF file"}},
      {"# only a comment\n", {"not an OFF file"}},
      {"off\n", {"line 1", "expected OFF"}},
      {"4OFF\n", {"line 1", "other dimensions"}},
      {"nOFF\n", {"line 1", "other dimensions"}},
      {"SKEL\n", {"line 1", "expected OFF"}},
      {"OFF BINARY\n", {"line 1", "only text files"}},
      {"OFF\n", {"ends after its first line"}},
      {"OFF\nthree one\n", {"line 2", "numbers of vertices, faces"}},
      {"OFF\n-3 1 0\n" + points, {"line 2", "numbers of vertices, faces"}},
      {"OFF\n1000000000000 1 0\n" + points, {"line 2", "promises 1000000000000 vertices"}},
      {"OFF\n3 1000000000000 0\n" + points, {"line 2", "1000000000000 faces"}},
      {"OFF\n0 0 0\n", {"no faces"}},
      {start + "0 0 0\n1 0 0\n", {"line 4", "2 of 3 vertices"}},
      {start + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", {"line 4", "three finite numbers"}},
      {start + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", {"line 4", "three finite numbers"}},
      {start + points, {"line 5", "0 of 1 faces"}},
      {start + points + "2 0 1\n", {"no faces with three"}},
      {start + points + "x 0 1\n", {"line 6", "3 or more"}},
      {start + points + "-3 0 1 2\n", {"line 6", "3 or more"}},
      {start + points + "3 0 1\n", {"line 6", "ends before corner 3"}},
      {start + points + "3 0\n1\nx\n", {"line 8", "corner 3"}},
      {"OFF\n3 2 0\n" + points + "3 0 1\n3 2 1 0\n", {"line 7", "corner 3"}},
      {"OFF\n3 3 0\n" + points + "3 0 1\n2 1 0 2\n3 0 1 2\n", {"line 8", "2 of 3 faces", "the face of line 6"}},
      {"OFFx 3 1 0\n" + points, {"line 1", "\"OFFx\""}},
      {"OFF-3 1 0\n" + points, {"line 1", "\"OFF-3\""}},
      {"3\n1\n", {"line 1", "numbers of vertices, faces"}},
      {start + points + "3 0 1 3\n", {"line 6", "corner 3", "3 vertices"}},
      {start + points + "3 0 -1 2\n", {"line 6", "corner 2"}},
      {start + points + "3 0 1.5 2\n", {"line 6", "corner 2"}},
      {start + points + "4000000000 0 1 2\n", {"line 6", "corner 4"}},
  };
  for (const auto& [text, parts] : cases) {
    for (const std::string& part : parts) {
      test::expect_input_error([&bytes = text] { test::read_bytes(read_off, bytes, "mesh.off"); }, {"mesh.off", part});
    }
  }
}

}  // namespace
}  // namespace orchard
