#include "orchard/geometry/mesh_io.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>

#include "expect_input_error.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;

class MeshIo : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("orchard_mesh_io_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_;
};

constexpr const char* kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr const char* kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr const char* kStl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";

TEST_F(MeshIo, ChoosesTheReaderByExtensionWhateverItsCase) {
  const std::pair<const char*, const char*> files[] = {{"a.obj", kObj}, {"b.OBJ", kObj}, {"c.ply", kPly},
                                                       {"d.Ply", kPly}, {"e.off", kOff}, {"f.x.OFF", kOff},
                                                       {"g.stl", kStl}, {"h.STL", kStl}};
  for (const auto& [name, text] : files) {
    write_file(folder_ / name, text);
    const TriangleMesh mesh = read_mesh(folder_ / name);
    EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << name;
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}})) << name;
  }
}

TEST_F(MeshIo, SaysWhatIsWrongWithAFileItCannotOpen) {
  fs::create_directories(folder_ / "folder.obj");
  write_file(folder_ / "empty.obj", "");
  write_file(folder_ / "mesh.xyz", kObj);
  write_file(folder_ / "mesh", kObj);
  const std::pair<const char*, const char*> cases[] = {
      {"none.obj", "no such file"},       {"none/none.ply", "no such file"},   {"folder.obj", "a folder"},
      {"empty.obj", "the file is empty"}, {"mesh.xyz", "unknown mesh format"}, {"mesh", "known are .obj, .ply, .stl"},
  };
  for (const auto& [name, fault] : cases) {
    const fs::path file = folder_ / name;
    test::expect_input_error([&] { read_mesh(file); }, {file.string(), fault});
  }
  test::expect_input_error([] { read_mesh(""); }, {"unknown mesh format"});
}

TEST_F(MeshIo, DoesNotWaitForADevice) {
  if (!fs::exists("/dev/zero")) GTEST_SKIP();
  fs::create_symlink("/dev/zero", folder_ / "zero.obj");
  test::expect_input_error([&] { read_mesh(folder_ / "zero.obj"); }, {"not a regular file"});
}

// One limit, here: what is larger made trees that no reader took.
TEST_F(MeshIo, RefusesMeshesOfASizeThatNothingWorksWith) {
  const auto written = [&](const std::string& name, double scale, double offset = 0) {
    fs::path file = folder_ / name;
    write_obj(file, test::transformed(test::box({-1, -1, -1}, {1, 1, 1}), scale, Vector::Constant(offset)));
    return file;
  };
  EXPECT_NO_THROW(read_mesh(written("largest.obj", kMaxCoordinate)));
  EXPECT_NO_THROW(read_mesh(written("least.obj", kMinExtent / 2)));
  for (const auto& [scale, offset] :
       {std::pair{1.001 * kMaxCoordinate, 0.0}, {1e20, 0.0}, {1.0, -1e16}, {1e300, 0.0}}) {
    const fs::path file = written("large.obj", scale, offset);
    test::expect_input_error([&] { (void)read_mesh(file); },
                             {"large.obj", "vertex 0", "limit of 1e+15", "scale the mesh down"});
  }
  for (const double scale : {0.499 * kMinExtent, 1e-20, 1e-300})
    test::expect_input_error([&] { (void)read_mesh(written("small.obj", scale)); },
                             {"small.obj", "limit of 1e-12", "scale the mesh up"});
}

TEST_F(MeshIo, ReadsBackExactlyWhatItWrote) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed, 1);
    TriangleMesh mesh;
    while (mesh.vertices.size() < 1000) {
      // Any finite doubles at all, and more friendly ones.
      const auto any = [&] { return std::bit_cast<double>(random.bits()); };
      const Point point = seed % 2 ? Point(any(), any(), any()) : Point(random.uniform(-1, 1), random.uniform(), 0.1);
      if (point.allFinite()) mesh.vertices.push_back(point);
    }
    for (int i = 0; i < 1000; ++i) {
      const auto corner = [&] { return static_cast<Index>(random.below(mesh.vertices.size())); };
      mesh.triangles.push_back({corner(), corner(), corner()});
    }
    write_obj(folder_ / "mesh.obj", mesh);
    // Not read_mesh(), which refuses sizes that nothing works with.
    const TriangleMesh read = read_points_or_mesh(folder_ / "mesh.obj");
    EXPECT_EQ(read.vertices, mesh.vertices) << seed;
    EXPECT_EQ(read.triangles, mesh.triangles) << seed;
  }
}

TEST_F(MeshIo, WritesTheSameBytesForTheSameMesh) {
  const auto bytes = [&](const char* name) {
    write_obj(folder_ / name, test::icosphere(2));
    std::ifstream stream(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const std::string first = bytes("a.obj");
  EXPECT_EQ(first, bytes("b.obj"));
  EXPECT_TRUE(first.starts_with("v "));
  EXPECT_TRUE(first.ends_with('\n'));
}

TEST_F(MeshIo, ReportsAFolderItCannotWriteTo) {
  EXPECT_THROW(write_obj(folder_ / "none" / "mesh.obj", test::l_shape()), Error);
}

}  // namespace
}  // namespace orchard
