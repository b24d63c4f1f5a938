#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "expect_input_error.h"
#include "io/mesh_formats.h"
#include "io/ply_header.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"

namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

TriangleMesh read(std::string_view bytes) { return read_ply(bytes, "mesh.ply"); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

const PlyType kTypes[] = {PlyType::int8,  PlyType::uint8,  PlyType::int16,   PlyType::uint16,
                          PlyType::int32, PlyType::uint32, PlyType::float32, PlyType::float64};
const char* const kNames[][2] = {{"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
                                 {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};

// Writes numbers as one encoding has them.
class Body {
 public:
  explicit Body(PlyEncoding encoding) : encoding_(encoding) {}
  void put(PlyType type, double value) {
    switch (type) {
      case PlyType::int8:
        return put_as<std::int8_t>(value);
      case PlyType::uint8:
        return put_as<std::uint8_t>(value);
      case PlyType::int16:
        return put_as<std::int16_t>(value);
      case PlyType::uint16:
        return put_as<std::uint16_t>(value);
      case PlyType::int32:
        return put_as<std::int32_t>(value);
      case PlyType::uint32:
        return put_as<std::uint32_t>(value);
      case PlyType::float32:
        return put_as<float>(value);
      case PlyType::float64:
        return put_as<double>(value);
    }
  }
  void end_row() {
    if (encoding_ == PlyEncoding::ascii) bytes_.back() = '\n';
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <typename T>
  void put_as(double value) {
    if (encoding_ == PlyEncoding::ascii) {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g ", static_cast<double>(static_cast<T>(value)));
      bytes_ += text;
      return;
    }
    const T exact = static_cast<T>(value);
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &exact, sizeof(T));
    const bool little = encoding_ == PlyEncoding::little_endian;
    if (little != (std::endian::native == std::endian::little)) std::ranges::reverse(raw);
    bytes_ += raw;
  }
  PlyEncoding encoding_;
  std::string bytes_;
};

const char* const kEncodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};

// A random file: property order, types, further properties and elements differ with the seed.
class RandomPly {
 public:
  // `strips`: the faces are in strips of triangles.
  RandomPly(std::uint64_t seed, PlyEncoding encoding, bool strips = false)
      : random_(seed, 1), header_("ply\nformat "), body_(encoding) {
    header_ += std::string(kEncodings[static_cast<std::size_t>(encoding)]) + " 1.0\ncomment seed\n";
    const bool faces_first = random_.below(4) == 0;
    for (int part = 0; part < 2; ++part) {
      if (random_.below(2)) add_extra_element("extra" + std::to_string(part));
      (part == 0) != faces_first ? add_vertices() : strips ? add_strips() : add_faces();
    }
    header_ += "obj_info hand-made\nend_header\n";
  }
  std::string bytes() const { return header_ + body_.bytes(); }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  static constexpr Index kVertices = 100;  // so that char can name them all

  PlyType any_type() { return kTypes[random_.below(8)]; }
  std::string name_of(PlyType type) { return kNames[static_cast<std::size_t>(type)][random_.below(2)]; }
  double any_number() { return static_cast<double>(random_.below(100)); }

  struct Column {
    PlyType type;
    bool list;
    PlyType length_type;
    std::string name;
  };
  // The named column among some that nobody needs, in random order.
  std::vector<Column> columns(std::vector<Column> named) {
    for (std::uint64_t i = random_.below(3); i > 0; --i) {
      named.push_back({any_type(), random_.below(3) == 0, any_type(), "extra" + std::to_string(i)});
    }
    for (std::size_t i = named.size() - 1; i > 0; --i) std::swap(named[i], named[random_.below(i + 1)]);
    for (const Column& column : named) {
      header_ += "property " + (column.list ? "list " + name_of(column.length_type) + " " : "") + name_of(column.type) +
                 " " + column.name + "\n";
    }
    return named;
  }
  void put_unneeded(const Column& column) {
    const std::uint64_t count = column.list ? random_.below(4) : 1;
    if (column.list) body_.put(column.length_type, static_cast<double>(count));
    for (std::uint64_t i = 0; i < count; ++i) body_.put(column.type, any_number());
  }
  void add_extra_element(const std::string& name) {
    header_ += "element " + name + " 3\n";
    const auto layout = columns({{any_type(), false, any_type(), "x"}});
    for (int row = 0; row < 3; ++row) {
      for (const Column& column : layout) put_unneeded(column);
      body_.end_row();
    }
  }
  void add_vertices() {
    header_ += "element vertex " + std::to_string(kVertices) + "\n";
    const auto layout = columns({{any_type(), false, any_type(), "x"},
                                 {any_type(), false, any_type(), "y"},
                                 {any_type(), false, any_type(), "z"}});
    for (Index row = 0; row < kVertices; ++row) {
      Point& point = mesh_.vertices.emplace_back();
      for (const Column& column : layout) {
        const std::size_t axis = std::string("xyz").find(column.name);
        if (axis == std::string::npos) {
          put_unneeded(column);
          continue;
        }
        double value = any_number();
        if (column.type == PlyType::float64) value = random_.uniform(-1e9, 1e9);
        if (column.type == PlyType::float32) value = static_cast<float>(random_.uniform(-1, 1));
        point[static_cast<Eigen::Index>(axis)] = value;
        body_.put(column.type, value);
      }
      body_.end_row();
    }
  }
  void add_faces() {
    header_ += "element face 50\n";
    const auto layout = columns({{any_type(), true, any_type(), random_.below(2) ? "vertex_indices" : "vertex_index"}});
    for (int row = 0; row < 50; ++row) {
      for (const Column& column : layout) {
        if (!column.name.starts_with("vertex")) {
          put_unneeded(column);
          continue;
        }
        body_.put(column.length_type, 3);
        for (Index& corner : mesh_.triangles.emplace_back()) {
          corner = static_cast<Index>(random_.below(kVertices));
          body_.put(column.type, corner);
        }
      }
      body_.end_row();
    }
  }

  // As a picture of a strip has it: corners alternate between its two rims, and each triangle lies between three that
  // follow one another.
  void add_strips() {
    const std::uint64_t rows = random_.below(4);
    header_ += "element tristrips " + std::to_string(rows) + "\n";
    static constexpr std::array kLengths{PlyType::uint8, PlyType::int16, PlyType::int32};
    static constexpr std::array kSigned{PlyType::int8, PlyType::int16, PlyType::int32, PlyType::float64};
    const auto layout = columns({{kSigned.at(random_.below(4)), true, kLengths.at(random_.below(3)),
                                  random_.below(2) ? "vertex_indices" : "vertex_index"}});
    for (std::uint64_t row = 0; row < rows; ++row) {
      for (const Column& column : layout) {
        if (!column.name.starts_with("vertex")) {
          put_unneeded(column);
          continue;
        }
        const std::vector<int> list = random_strips();
        body_.put(column.length_type, static_cast<double>(list.size()));
        for (const int item : list) body_.put(column.type, item);
      }
      body_.end_row();
    }
  }
  std::vector<int> random_strips() {
    std::vector<int> list;
    for (std::uint64_t strips = random_.below(6); strips > 0; --strips) {
      std::vector<int> strip;
      for (std::uint64_t corners = random_.below(12); corners > 0; --corners) {
        strip.push_back(random_.below(5) == 0 && !strip.empty() ? strip.back()
                                                                : static_cast<int>(random_.below(kVertices)));
      }
      for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        std::array<int, 3> corners{strip[i], strip[i + 1], strip[i + 2]};
        if (i % 2 == 1) std::swap(corners[0], corners[1]);
        if (std::set<int>(corners.begin(), corners.end()).size() < 3) continue;
        mesh_.triangles.push_back(
            {static_cast<Index>(corners[0]), static_cast<Index>(corners[1]), static_cast<Index>(corners[2])});
      }
      list.insert(list.end(), strip.begin(), strip.end());
      if (strips > 1 || random_.below(2) == 0) list.push_back(-1);
    }
    return list;
  }

  Random random_;
  std::string header_;
  Body body_;
  TriangleMesh mesh_;
};

TEST(ReadPly, ReadsAnyTypesAndOrderInEveryEncoding) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::little_endian, PlyEncoding::big_endian}) {
      const RandomPly file(seed, encoding);
      const TriangleMesh mesh = read(file.bytes());
      ASSERT_EQ(mesh.vertices, file.mesh().vertices) << "seed " << seed << "\n" << file.bytes().substr(0, 600);
      ASSERT_EQ(mesh.triangles, file.mesh().triangles) << "seed " << seed;
    }
  }
}

TEST(ReadPly, ReadsStripsOfTrianglesInEveryEncoding) {
  std::size_t triangles = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    for (const PlyEncoding encoding : {PlyEncoding::ascii, PlyEncoding::little_endian, PlyEncoding::big_endian}) {
      const RandomPly file(seed, encoding, true);
      const TriangleMesh mesh = read_ply_or_points(file.bytes(), "mesh.ply");
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
  const TriangleMesh mesh = read(text + "6 1 0 2 3 1 0\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{1, 0, 2}, {2, 0, 3}, {2, 3, 1}, {1, 3, 0}}));
  EXPECT_TRUE(check_mesh(mesh).solid()) << check_mesh(mesh).faults();
  // Three of its triangles in two strips.
  EXPECT_EQ(read(text + "8 0 2 1 3 -1 2 0 3\n").triangles, (Triangles{{0, 2, 1}, {1, 2, 3}, {2, 0, 3}}));
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
  EXPECT_EQ(read(text("3 0 1 2\n")).triangles.size(), 1u);
  test::expect_input_error([&] { read(text("3 0 1 3\n")); }, {"mesh.ply, line 13", "strip of triangles", "vertex 3"});
  test::expect_input_error([&] { read(text("3 0 1 -2\n")); }, {"mesh.ply, line 13", "vertex -2"});
  test::expect_input_error([&] { read(text("9 0 1 2\n")); }, {"mesh.ply, line 13", "9 items"});
  test::expect_input_error([&] { read(text("2 0 1\n")); }, {"no faces"});
  test::expect_input_error([&] { read(text("4 0 1 -1 2\n")); }, {"no faces"});
  test::expect_input_error([&] { read(replaced(text("3 0 1 2\n"), "vertex_indices", "corners")); },
                           {"line 7", "no list"});
}

TEST(ReadPly, RefusesARandomFileCutShort) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const std::string bytes = RandomPly(seed, PlyEncoding::little_endian).bytes();
    const std::size_t size = Random(seed, 3).below(bytes.size());
    test::expect_input_error([&] { read(std::string_view(bytes).substr(0, size)); }, {"mesh.ply"});
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
    EXPECT_EQ(read(converted).triangles, (Triangles{{0, 1, 2}}));
    // A binary body may begin with the byte that ends lines elsewhere.
    std::string binary;
    for (const char c : replaced(header("binary_big_endian"), "float x", "uchar x")) {
      binary += c == '\n' ? end : std::string(1, c);
    }
    Body body(PlyEncoding::big_endian);
    for (int i = 0; i < 3; ++i) {
      body.put(PlyType::uint8, '\n');
      body.put(PlyType::float32, i);
      body.put(PlyType::float32, i * i);
    }
    body.put(PlyType::uint8, 3);
    for (const int i : {2, 1, 0}) body.put(PlyType::int32, i);
    const TriangleMesh mesh = read(binary + body.bytes());
    EXPECT_EQ(mesh.vertices[0], Point(10, 0, 0));
    EXPECT_EQ(mesh.triangles, (Triangles{{2, 1, 0}}));
  }
}

TEST(ReadPly, ReadsAHeaderOfAHundredThousandElements) {
  std::string elements;
  for (int i = 0; i < 100000; ++i) ((elements += "element e") += std::to_string(i)) += " 0\n";
  const std::string text = header("ascii") + kPoints + "3 0 1 2\n";
  EXPECT_EQ(read(replaced(text, "element vertex", elements + "element vertex")).triangles.size(), 1u);
}

TEST(ReadPly, TriangulatesPolygons) {
  EXPECT_EQ(read(header("ascii", "4") + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").triangles,
            (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ReadPly, NamesTheLineAndTheFaultOfAsciiFiles) {
  const std::string good = header("ascii") + kPoints + "3 0 1 2\n", three = header("ascii") + kPoints;
  EXPECT_NO_THROW(read(good));
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
      {header("ascii") + "0 0 0\n1 0 0\n0 1e999 0\n3 0 1 2\n", {"line 12", "\"1e999\" is not a number"}},
      {header("ascii") + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", {"line 11", "\"zero\" is not a number"}},
      {header("ascii") + "0 0 0\n1 0 0\n", {"line 12", "ends early"}},
      {three, {"line 13", "ends early"}},
      {three + "3 0 1", {"line 13", "ends early"}},
      {three + "3 0 1 3\n", {"line 13", "vertex 3", "3 vertices"}},
      {three + "3 0 1 -1\n", {"line 13", "vertex -1"}},
      {three + "3 0 1 1.5\n", {"line 13", "not an integer"}},
      {three + "2 0 1\n", {"line 13", "2 corners"}},
      {three + "-3 0 1 2\n", {"line 13", "-3 items"}},
      {three + "9999 0 1 2\n", {"line 13", "9999 items"}},
      {header("ascii", "3", "0") + kPoints, {"no faces"}},
      {"ply\nformat ascii 1.0\nelement nothing 999999999999\nend_header\n", {"no faces"}},
  };
  for (const auto& [text, parts] : cases) {
    for (const std::string& part : parts) test::expect_input_error([&] { read(text); }, {"mesh.ply", part});
  }
}

TEST(ReadPly, NamesTheByteAndTheFaultOfBinaryFiles) {
  const std::string head = header("binary_little_endian");
  const auto file = [&](float coordinate, double length, double corner) {
    Body body(PlyEncoding::little_endian);
    for (int i = 0; i < 9; ++i) body.put(PlyType::float32, i == 4 ? coordinate : static_cast<float>(i));
    body.put(PlyType::uint8, length);
    for (int i = 0; i < 3; ++i) body.put(PlyType::int32, i == 1 ? corner : 0);
    return head + body.bytes();
  };
  const auto byte = [&](std::size_t offset) { return "byte " + std::to_string(head.size() + offset); };
  const std::string good = file(1, 3, 1);
  EXPECT_NO_THROW(read(good));
  test::expect_input_error([&] { read(file(NAN, 3, 1)); }, {byte(16), "not a finite number"});
  test::expect_input_error([&] { read(file(-INFINITY, 3, 1)); }, {byte(16), "not a finite number"});
  test::expect_input_error([&] { read(file(1, 2, 1)); }, {byte(36), "2 corners"});
  test::expect_input_error([&] { read(file(1, 4, 1)); }, {byte(36), "4 items"});
  test::expect_input_error([&] { read(file(1, 3, 3)); }, {byte(41), "vertex 3"});
  test::expect_input_error([&] { read(file(1, 3, -1)); }, {byte(41), "vertex -1"});
  test::expect_input_error([&] { read(good.substr(0, good.size() - 1)); }, {byte(36), "3 items"});
  test::expect_input_error([&] { read(good.substr(0, good.size() - 20)); }, {"line 3", "promises 3 rows"});
  test::expect_input_error([&] { read(replaced(good, "vertex 3", "vertex 1000000000000")); },
                           {"promises 1000000000000"});
}

}  // namespace
}  // namespace orchard
