#include "orchard/medial/medial_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"

namespace orchard {
namespace {

class MaFile : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    file_ = std::filesystem::temp_directory_path() / ("orchard-" + name + ".ma");
  }
  void TearDown() override { std::filesystem::remove(file_); }

  MedialMesh read(const std::string& text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return read_ma(file_);
  }
  std::string fault(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  std::filesystem::path file_;
};

TEST_F(MaFile, GivesBackEveryBit) {
  MedialMesh mesh;
  Random random(5, 0);
  for (int i = 0; i < 50; ++i) {
    mesh.centers.emplace_back(random.uniform(-1e6, 1e6), random.uniform(-1e-6, 1e-6), random.uniform());
    mesh.radii.push_back(random.uniform());
  }
  for (Index i = 0; i + 2 < 50; i += 3) mesh.triangles.push_back({i, i + 2, i + 1});
  mesh.edges.push_back({49, 0});
  complete(mesh);
  const MedialMesh back = read(to_ma(mesh));
  EXPECT_EQ(back.centers, mesh.centers);
  EXPECT_EQ(back.radii, mesh.radii);
  EXPECT_EQ(back.edges, mesh.edges);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(to_ma(back), to_ma(mesh));
}

TEST_F(MaFile, OfOtherSystemsMayLackEdgesAndHoldComments) {
  const MedialMesh mesh =
      read("# from elsewhere\r\n3 0 1\r\nv 0 0 0 1 0.5 extra\r\n\nv 1 0 0 1\nv 0 1 0 1e-3\nf 2 0 1");
  EXPECT_EQ(mesh.size(), 3u);
  EXPECT_EQ(mesh.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}}));
}

TEST_F(MaFile, ThatIsDamagedIsRefusedByNameAndLine) {
  EXPECT_NE(fault("").find("is empty"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 0 zero 1\n").find("line 2"), std::string::npos);
  EXPECT_NE(fault("2 0 0\nv 0 0 0 1\n").find("cut off"), std::string::npos);
  EXPECT_NE(fault("4294967295 0 0\nv 0 0 0 1\n").find("cut off"), std::string::npos);
  EXPECT_NE(fault("1 1 0\nv 0 0 0 1\ne 0 1\n").find("beyond the last vertex"), std::string::npos);
  EXPECT_NE(fault("1 1 0\nv 0 0 0 1\ne 0 0\n").find("twice"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 0 0 -1\n").find("negative radius"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 nan 0 1\n").find("not finite"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nx 0 0 0 1\n").find("starts with \"v\""), std::string::npos);
  EXPECT_NE(fault("-1 0 0\n").find("whole number"), std::string::npos);
  EXPECT_THROW(read_ma("no/such/file.ma"), InputError);
}

MedialAxis polygon_axis(Index corners) {
  MedialAxis axis;
  axis.points = {{0, 0, 1}, {0, 0, -1}};
  for (Index i = 0; i < corners; ++i) {
    const double angle = 6.28 * i / corners;
    axis.centers.emplace_back(std::cos(angle), std::sin(angle), 0);
    axis.radii.push_back(std::sqrt(2));
    axis.faces.items.push_back(i);
    axis.neighbors.items.push_back((i + 1) % corners);
    axis.neighbors.items.push_back((i + corners - 1) % corners);
    axis.neighbors.close_row();
  }
  axis.faces.close_row();
  axis.face_points = {{0, 1}};
  return axis;
}

TEST(MedialMesh, CutsFacesIntoFans) {
  const MedialMesh mesh = medial_mesh(polygon_axis(7));
  validate(mesh);
  EXPECT_EQ(mesh.size(), 7u);
  EXPECT_EQ(mesh.triangles.size(), 5u);
  EXPECT_EQ(mesh.edges.size(), 11u);
}

TEST(MedialMesh, PutsAVertexWhereEveryFanWouldRepeatAnEdge) {
  MedialAxis axis = polygon_axis(4);  // and both diagonals
  axis.neighbors = {};
  for (Index i = 0; i < 4; ++i) {
    for (Index k = 0; k < 4; ++k) {
      if (k != i) axis.neighbors.items.push_back(k);
    }
    axis.neighbors.close_row();
  }
  const MedialMesh mesh = medial_mesh(axis);
  validate(mesh);
  ASSERT_EQ(mesh.size(), 5u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(mesh.radii[4], 1, 0.01);
}

TEST(MedialMesh, ValidationNamesTheFault) {
  MedialMesh mesh = medial_mesh(polygon_axis(5));
  mesh.radii[3] = -1;
  EXPECT_THROW(validate(mesh), InputError);
  mesh = medial_mesh(polygon_axis(5));
  mesh.centers[1].x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(validate(mesh), InputError);
  mesh = medial_mesh(polygon_axis(5));
  mesh.edges.erase(mesh.edges.begin());
  EXPECT_THROW(validate(mesh), InputError);
  EXPECT_THROW(validate(MedialMesh{}), InputError);
}

}  // namespace
}  // namespace orchard
