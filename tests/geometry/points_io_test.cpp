#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "expect_input_error.h"
#include "orchard/geometry/mesh_io.h"
#include "read_bytes.h"

namespace orchard {
namespace {

using Points = std::vector<Point>;

Points xyz(std::string_view bytes) { return test::read_bytes(read_xyz, bytes, "points.xyz").vertices; }

TEST(ReadXyz, TakesThreeNumbersALine) {
  EXPECT_EQ(xyz("0 0 0\n1.5 -2 3e2"), (Points{{0, 0, 0}, {1.5, -2, 300}}));
  EXPECT_EQ(xyz("  0.1\t0.2   0.3  \n"), (Points{{0.1, 0.2, 0.3}}));
  EXPECT_EQ(xyz("1,2,3\n4, 5 ,6\n"), (Points{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(xyz("\xef\xbb\xbf+1 2. .5\r\n4 5 6\r7 8 9"), (Points{{1, 2, 0.5}, {4, 5, 6}, {7, 8, 9}}));
}

TEST(ReadXyz, SkipsCommentsBlankLinesAndFurtherColumns) {
  EXPECT_EQ(xyz("# a cloud\n\n1 2 3 0 0 1 red # tail\n   \n4 5 6#7\n"), (Points{{1, 2, 3}, {4, 5, 6}}));
}

TEST(ReadXyz, KeepsEveryBit) {
  EXPECT_EQ(xyz("0.1 1e-308 4.9406564584124654e-324\n0.30000000000000004 1e-400 -0\n"),
            (Points{{0.1, 1e-308, 4.9406564584124654e-324}, {0.30000000000000004, 0, 0}}));
}

TEST(ReadXyz, NamesTheLineAndTheFault) {
  const auto refuses = [](const char* bytes, std::initializer_list<std::string> parts) {
    test::expect_input_error([&] { xyz(bytes); }, parts);
  };
  refuses("0 0 0\n1 2\n", {"points.xyz, line 2", "2 coordinates", "needs 3"});
  refuses("0 0 0\r\n\r\n1 2 x\n", {"line 3", "\"x\"", "not a number"});
  refuses("1 2 nan", {"no points"});
  refuses("1e999 2 3", {"no points"});
  refuses("1 2 3abc", {"line 1", "\"3abc\""});
  refuses("3\nwater\nO 0 0 0", {"line 1", "1 coordinates"});
  refuses("", {"no points", "0 bytes"});
  refuses("# nothing\n", {"no points"});
  test::expect_input_error([] { test::read_bytes(read_xyz, std::string_view("1 2\0 3", 6), "points.xyz"); },
                           {"byte 3", "zero byte"});
}

TEST(ReadPointsOrMesh, TakesVerticesWithoutFaces) {
  const TriangleMesh obj = test::read_bytes(read_obj_or_points, "v 1 2 3\nv 4 5 6\n", "p.obj");
  EXPECT_EQ(obj.vertices, (Points{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(obj.triangles.empty());
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
      "property double z\n";
  const TriangleMesh ply = test::read_bytes(read_ply_or_points, header + "end_header\n1 2 3\n4 5 6\n", "p.ply");
  EXPECT_EQ(ply.vertices, obj.vertices);
  EXPECT_TRUE(ply.triangles.empty());
  const TriangleMesh none = test::read_bytes(
      read_ply_or_points, header + "element face 0\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n4 5 6\n",
      "p.ply");
  EXPECT_EQ(none.vertices, obj.vertices);
  EXPECT_TRUE(none.triangles.empty());
}

TEST(ReadPointsOrMesh, KeepsTheFacesThatThereAre) {
  const TriangleMesh mesh = test::read_bytes(read_obj_or_points, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "p.obj");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  test::expect_input_error([] { test::read_bytes(read_obj_or_points, "v 0 0 0\nf 1 2 3\n", "p.obj"); },
                           {"p.obj", "vertex 3"});
}

TEST(ReadPointsOrMesh, RefusesFilesWithoutVertices) {
  test::expect_input_error([] { test::read_bytes(read_obj_or_points, "# empty\n", "p.obj"); },
                           {"p.obj", "no vertices"});
  test::expect_input_error(
      [] {
        test::read_bytes(read_ply_or_points,
                         "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                         "property float z\nend_header\n",
                         "p.ply");
      },
      {"p.ply", "no vertices"});
}

TEST(ReadPointsOrMesh, ChoosesTheReaderByExtension) {
  const auto folder = std::filesystem::temp_directory_path() / "orchard_points_io_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "cloud.XYZ") << "1 2 3\n";
  EXPECT_EQ(read_points_or_mesh(folder / "cloud.XYZ").vertices, (Points{{1, 2, 3}}));
  std::ofstream(folder / "cloud.pts") << "1 2 3\n";
  test::expect_input_error([&] { read_points_or_mesh(folder / "cloud.pts"); }, {"cloud.pts", ".xyz", ".ply"});
  test::expect_input_error([&] { read_points_or_mesh(folder / "none.xyz"); }, {"none.xyz", "no such file"});
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace orchard
