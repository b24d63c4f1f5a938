#include <gtest/gtest.h>

#include <cmath>

#include "expect_input_error.h"
#include "read_bytes.h"

namespace orchard {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

TriangleMesh read_obj_text(std::string_view text) { return test::read_bytes(read_obj, text, "mesh.obj"); }

constexpr std::string_view kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, TakesEveryFormOfACorner) {
  const struct {
    const char* name;
    std::string face;
  } cases[] = {
      {"v", "f 1 2 3"},
      {"v/vt", "f 1/1 2/2 3/3"},
      {"v//vn", "f 1//1 2//1 3//1"},
      {"v/vt/vn", "f 1/1/1 2/2/2 3/3/3"},
      {"negative", "f -4 -3 -2"},
      {"negative, all three", "f -4/-1/-1 -3/-1/-1 -2/-1/-1"},
      {"mixed", "f 1 -3/1 3//-1"},
      {"plus signs", "f +1 +2 +3"},
      {"empty texture and normal", "f 1// 2/ 3"},
      {"tabs and trailing blanks", "f\t1 \t2  3 \t"},
      {"leading blanks", "  \tf 1 2 3"},
      {"trailing comment", "f 1 2 3 # 4"},
      {"comment that touches", "f 1 2 3#4"},
      {"continued", "f 1 \\\n 2 \\\r\n\\\n 3"},
      {"continued between characters that do not belong together", "f 1\\\n2\\\n3"},
      {"old keyword", "fo 1 2 3"},
  };
  for (const auto& [name, face] : cases) {
    const TriangleMesh mesh = read_obj_text(std::string(kFour) + face + "\n");
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}})) << name;
    EXPECT_EQ(mesh.vertices.size(), 4u) << name;
  }
}

TEST(ReadObj, TakesEveryFormOfAVertex) {
  const struct {
    const char* name;
    std::string vertex;
    Point point;
  } cases[] = {
      {"plain", "v 1 -2 3.5", {1, -2, 3.5}},
      {"exponents", "v 1e3 -2.5E-2 +3e+1", {1000, -0.025, 30}},
      {"bare points", "v .5 2. -.25", {0.5, 2, -0.25}},
      {"colours", "v 1 2 3 0.5 0.5 0.5", {1, 2, 3}},
      {"weight", "v 1 2 3 1.0", {1, 2, 3}},
      {"many digits", "v 0.1000000000000000055511151231257827 3 3", {0.1, 3, 3}},
      {"too small for a double", "v 1e-400 -2e-99999999999999999999 0.0e5", {0, 0, 0}},
      {"too small without an exponent", "v 0." + std::string(400, '0') + "1 3 4", {0, 3, 4}},
      {"many zeros, balanced by the exponent",
       "v 0." + std::string(400, '0') + "1e401 1" + std::string(400, '0') + "e-400 4",
       {1, 1, 4}},
      {"subnormal", "v 4.9406564584124654e-324 0 1", {4.9406564584124654e-324, 0, 1}},
      {"continued", "v 1 \\\n 2 \\\r\n 3", {1, 2, 3}},
      {"tabs", "v\t1\t2\t3", {1, 2, 3}},
      {"comment", "v 1 2 3#4", {1, 2, 3}},
  };
  for (const auto& [name, vertex, point] : cases) {
    const TriangleMesh mesh = read_obj_text(vertex + "\nf 1 1 1\n");
    ASSERT_EQ(mesh.vertices.size(), 1u) << name;
    EXPECT_EQ(mesh.vertices[0], point) << name << ": " << mesh.vertices[0].transpose();
  }
}

TEST(ReadObj, TakesEveryEndOfLine) {
  for (const std::string_view end : {"\n", "\r\n", "\r", "\n\n", "\r\n\r\n"}) {
    for (const bool final : {true, false}) {
      std::string text;
      for (const std::string_view line : {"# a comment", "v 0 0 0", "v 1 0 0", "v 0 1 0", "", "f 1 2 3"}) {
        text += std::string(text.empty() ? "" : end) + std::string(line);
      }
      if (final) text += end;
      const TriangleMesh mesh = read_obj_text(text);
      EXPECT_EQ(mesh.vertices.size(), 3u);
      EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    }
  }
}

TEST(ReadObj, SkipsWhatItHasNoUseFor) {
  const TriangleMesh mesh = read_obj_text(
      "\xef\xbb\xbf# byte order mark \\\nmtllib a.mtl\no name\ng one two\ns off\nusemtl red \\\nv 9 9 9\nvt 0 0\nvn 0 "
      "0 1\n"
      "vp 1 2\nvolume 1 2 3\nfancy 1 2\nl 1 2\np 1\ncurv 0 1 1 2\n" +
      std::string(kFour) + "f 1 2 3\n");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
}

TEST(ReadObj, AllowsFacesBeforeTheirVertices) {
  EXPECT_EQ(read_obj_text("f 1 2 3\nf 2 3 4\n" + std::string(kFour)).triangles, (Triangles{{0, 1, 2}, {1, 2, 3}}));
}

TEST(ReadObj, CountsNegativeIndicesFromTheFaceBackwards) {
  EXPECT_EQ(read_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n").triangles,
            (Triangles{{0, 1, 2}, {1, 2, 3}}));
}

TEST(ReadObj, TriangulatesPolygons) {
  EXPECT_EQ(read_obj_text(std::string(kFour) + "f 1 2 3 4\n").triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ReadObj, NamesTheLineAndTheFault) {
  const std::string four(kFour);
  const struct {
    std::string text;
    std::vector<std::string> parts;
  } cases[] = {
      {"v 1 2\nf 1 1 1\n", {"line 1", "2 coordinates"}},
      {"\n\nv 1\nf 1 1 1\n", {"line 3", "1 coordinates"}},
      {"v 1 x 3\n", {"line 1", "\"x\" is not a number"}},
      {"v 1 2 3x\n", {"line 1", "\"3x\""}},
      {"v 1,5 2 3\n", {"line 1", "\"1,5\""}},
      {"v 0 0 0\r\nv nan 0 0\r\nv 0 0 1\r\nf 1 2 3\r\n", {"line 2", "\"nan\""}},
      {"v 0 0 0\rv 0 -inf 0\rv 1 1 1\rf 3 2 1\r", {"line 2", "\"-inf\""}},
      {"v 1e999 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", {"line 1", "\"1e999\""}},
      {"v 0x10 0 0\n", {"line 1", "\"0x10\""}},
      {four + "f 1 2\n", {"no faces", "three corners"}},
      {four + "f\n", {"no faces", "three corners"}},
      {four + "f 1 2 0\n", {"line 5", "vertex 0", "counts from 1"}},
      {four + "f 1 2 5\n", {"line 5", "vertex 5", "4 vertices"}},
      {four + "f 1 2 9\nf 1 2 7\n", {"line 5", "vertex 9"}},
      {four + "f 1 2 6\nf 1 2 9\nf 1 2 7\nv 0 0 0\nv 1 1 1\n", {"line 6", "vertex 9", "6 vertices"}},
      {four + "f 1 2 -5\n", {"line 5", "vertex -5", "4 vertices"}},
      {four + "f 1 2 4294967296\n", {"line 5", "4294967296"}},
      {four + "f 1 2 99999999999999999999\n", {"line 5", "99999999999999999999"}},
      {four + "f 1 2 3.5\n", {"line 5", "\"3.5\""}},
      {four + "f 1 2 3/x\n", {"line 5", "\"3/x\""}},
      {four + "f 1 2 3/1/1/1\n", {"line 5", "\"3/1/1/1\""}},
      {four + "f 1 2 /3\n", {"line 5", "\"/3\""}},
      {four + "f 1 2 3 \\\n 4 \\\n bad\n", {"line 7", "\"bad\""}},
      {four, {"mesh.obj", "no faces"}},
      {"", {"mesh.obj", "no faces"}},
      {"nothing of the kind\n", {"no faces"}},
      {std::string("v 0 0 0\n\0\n", 10), {"byte 8", "not an OBJ text file"}},
      {four + "f 1 2 \x01\x02\xff\n", {"line 5", "\"???\""}},
      {four + "f 1 2 " + std::string(1000, 'a'), {"line 5", "aaa...\""}},
  };
  for (const auto& [text, parts] : cases) {
    for (const std::string& part : parts)
      test::expect_input_error([&, &text = text] { read_obj_text(text); }, {"mesh.obj", part});
  }
}

TEST(ReadObj, ReadsAPolygonOfAHundredThousandCorners) {
  constexpr int n = 100000;
  std::string text, face = "f";
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * i / n;
    ((text += "v ") += std::to_string(std::cos(angle))) += ' ';
    (text += std::to_string(std::sin(angle))) += " 0\n";
    (face += ' ') += std::to_string(i + 1);
  }
  EXPECT_EQ(read_obj_text(text + face).triangles.size(), static_cast<std::size_t>(n - 2));
}

}  // namespace
}  // namespace orchard
