#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "expect_input_error.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/random.h"
#include "read_bytes.h"
#include "support/effort.h"
#include "support/shapes.h"

// .stl files as programs write them, which is not always as the format has it.
namespace orchard {
namespace {

TriangleMesh shape(Random& random) {
  switch (random.below(4)) {
    case 0:
      return test::l_shape();
    case 1:
      return test::u_shape(0.5);
    case 2:
      return test::icosphere(1);
    default:
      return test::box(Point(0, 0, 0), Point(1, 2, 3));
  }
}

// Words of an ASCII file, each of which may have been written in another way.
class Dialect {
 public:
  explicit Dialect(Random& random) : random_(random), upper_(random.below(3)), one_line_(random.below(3)) {}

  std::string file(const TriangleMesh& mesh) {
    std::string text = random_.below(3) == 0 ? "\xef\xbb\xbf" : "";
    const std::size_t solids = 1 + random_.below(3), each = mesh.triangles.size() / solids + 1;
    for (std::size_t first = 0; first < mesh.triangles.size(); first += each) {
      text += word("solid") + name() + "\n";
      for (std::size_t t = first; t < std::min(first + each, mesh.triangles.size()); ++t) {
        text += word("facet") + word("normal") + (random_.below(3) == 0 ? "nan nan nan" : "0 0 1") + gap() +
                word("outer") + word("loop") + gap();
        for (const Index corner : mesh.triangles[t]) {
          text += word("vertex");
          for (const double x : mesh.vertices[corner]) text += std::to_string(x) + " ";
          text += gap();
        }
        text += end("loop") + gap() + end("facet") + gap();
      }
      text += "\n" + end("solid") + name() + "\n";
    }
    return text;
  }

 private:
  std::string word(std::string text) {
    const bool upper = upper_ == 1 || (upper_ == 2 && random_.below(2) == 0);
    if (upper)
      for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text + " ";
  }
  std::string end(const std::string& what) {
    return random_.below(3) == 0 ? word("end") + word(what) : word("end" + what);
  }
  std::string gap() {
    static constexpr std::array kGaps{"\n", "\r\n  ", "\r", "\t", "  ", "\n\n "};
    if (one_line_ == 0) return "\n";
    return one_line_ == 1 ? " " : kGaps.at(random_.below(kGaps.size()));
  }
  std::string name() {
    static constexpr std::array kNames{"", "part", "a solid part", "facet", "vertex 1 2 3", "Endsolid", "two\twords"};
    return kNames.at(random_.below(kNames.size()));
  }
  Random& random_;
  std::uint64_t upper_, one_line_;
};

void expect_same_solid(const TriangleMesh& mesh, const TriangleMesh& expected, std::uint64_t seed) {
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(mesh.triangles.size(), expected.triangles.size()) << seed;
  EXPECT_TRUE(report.closed()) << seed << ": " << report.faults();
  EXPECT_NEAR(report.volume, check_mesh(expected).volume, 1e-4) << seed;
}

TEST(ReadStl, KnowsTheDialectsOfText) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 21);
    const TriangleMesh mesh = shape(random);
    const std::string file = Dialect(random).file(mesh);
    MeshReadReport report;
    try {
      expect_same_solid(read_stl(file, "mesh.stl", report), mesh, seed);
    } catch (const InputError& error) {
      FAIL() << seed << ": " << error.what() << "\n" << file;
    }
    EXPECT_TRUE(report.lines().empty()) << seed << ": " << report.lines().front();
  }
}

TEST(ReadStl, SkipsFacetsOfTwoCornersInText) {
  MeshReadReport report;
  const std::string facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
  const std::string two = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 endloop endfacet\n";
  EXPECT_EQ(read_stl("solid\n" + facet + two + "endsolid\n", "mesh.stl", report).triangles.size(), 1u);
  EXPECT_EQ(report.faces_skipped.count, 1u);
  EXPECT_EQ(report.faces_skipped.first, "line 3");
}

std::string raw(const auto& value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

// attributes: bytes behind each facet, which says that it has them.
std::string binary(const TriangleMesh& mesh, const std::string& start, std::uint32_t count, bool normals = false,
                   std::uint16_t attributes = 0) {
  std::string bytes = start + std::string(80 - start.size(), ' ') + raw(count);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Point &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vector normal = normals ? (q - p).cross(r - p).normalized() : Vector::Zero();
    for (const Vector& v : {normal, Vector(p), Vector(q), Vector(r)})
      for (const double x : v) bytes += raw(static_cast<float>(x));
    bytes += raw(attributes) + std::string(attributes, 'a');
  }
  return bytes;
}

TEST(ReadStl, FindsTheFacetsThatAWrongCountLeavesOut) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 22);
    const TriangleMesh mesh = shape(random);
    const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto count = static_cast<std::uint32_t>(random.below(all));
    const std::string tail(random.below(3) == 0 ? random.below(50) : 0, 'x');
    MeshReadReport report;
    const std::string start = random.below(2) == 0 ? "solid" : "made by hand";
    expect_same_solid(read_stl(binary(mesh, start, count, random.below(2) == 0) + tail, "mesh.stl", report), mesh,
                      seed);
    EXPECT_EQ(report.facets_promised, count);
    EXPECT_EQ(report.facets_found, all);
    EXPECT_EQ(report.bytes_left_out, tail.size());
    EXPECT_FALSE(report.complete());
  }
}

TEST(ReadStl, SkipsAttributesAndWhatFollowsTheLastFacet) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 23);
    const TriangleMesh mesh = shape(random);
    const auto all = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto attributes = static_cast<std::uint16_t>(1 + random.below(300));
    MeshReadReport report;
    expect_same_solid(read_stl(binary(mesh, "solid", all, false, attributes), "mesh.stl", report), mesh, seed);
    EXPECT_EQ(report.attribute_bytes, std::uint64_t{attributes} * all) << seed;
    EXPECT_TRUE(report.complete()) << seed;
    // Garbage, text or zeros, of any length: never a facet.
    std::string tail;
    const std::uint64_t kind = random.below(3);
    for (std::uint64_t i = 0, bytes = 1 + random.below(400); i < bytes; ++i)
      tail += static_cast<char>(kind == 0 ? 0 : kind == 1 ? 32 + random.below(90) : random.below(256));
    MeshReadReport tailed;
    expect_same_solid(read_stl(binary(mesh, "solid", all, random.below(2) == 0) + tail, "mesh.stl", tailed), mesh,
                      seed);
    EXPECT_EQ(tailed.bytes_left_out, tail.size()) << seed;
    EXPECT_EQ(tailed.lines().size(), 1u) << seed;
  }
}

TEST(ReadStl, RefusesWhatHasFewerFacetsThanItCounts) {
  const TriangleMesh mesh = test::l_shape();
  for (const std::uint32_t count : {21u, 40u, 1u << 20, 0xffffffffu})
    test::expect_input_error([&] { test::read_bytes(read_stl, binary(mesh, "solid", count), "mesh.stl"); },
                             {"mesh.stl, byte 80", "promises " + std::to_string(count), "export it again"});
  test::expect_input_error([] { test::read_bytes(read_stl, std::string(80, ' ') + std::string(54, '\0'), "mesh.stl"); },
                           {"byte 80", "promises no triangles"});
}

}  // namespace
}  // namespace orchard
