#include "orchard/medial/medial_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/topology.h"

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

// Three balls in a triangle, and a fourth of radius 0, as MATFP leaves those that it took out.
constexpr const char* kMatfp =
    "4 4 1\nv 0 0 0 1 2 0\nv 1 0 0 1 3 0\nv 0 1 0 1 -1 0\nv 5 5 5 0 2 1\n"
    "e 0 1 1\ne 0 2 2\ne 1 2 0\ne 2 3 0\nf 0 1 2\n";

TEST_F(MaFile, DoesNotCountDeletedBalls) {
  const MedialMesh mesh = read(kMatfp);
  validate(mesh);
  EXPECT_EQ(mesh.size(), 3u);
  EXPECT_EQ(mesh.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}, {1, 2}}));
  EXPECT_EQ(topology(mesh).components, 1);
  const MedialMesh lone = read("3 1 0\nv 9 9 9 0 1 1\nv 0 0 0 1 1 0\nv 1 0 0 1 1 0\ne 1 2 0\n");
  EXPECT_EQ(lone.size(), 2u);
  EXPECT_EQ(lone.edges, (std::vector<std::array<Index, 2>>{{0, 1}}));
  EXPECT_EQ(topology(lone).components, 1);
}

TEST_F(MaFile, DoesNotCountDeletedEdgesAndFaces) {
  const std::string balls = "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\n";
  const MedialMesh without_edge = read("3 3 1\n" + balls + "e 0 1 1 1\ne 0 2 0 0\ne 1 2 0 0\nf 0 1 2 0\n");
  EXPECT_EQ(without_edge.edges, (std::vector<std::array<Index, 2>>{{0, 2}, {1, 2}}));
  EXPECT_TRUE(without_edge.triangles.empty());  // a triangle needs its edges
  const MedialMesh without_face = read("3 3 1\n" + balls + "e 0 1\ne 0 2\ne 1 2\nf 0 1 2 1\n");
  EXPECT_EQ(without_face.edges.size(), 3u);
  EXPECT_TRUE(without_face.triangles.empty());
  EXPECT_EQ(topology(without_face).loops, 1);
  // Edges that are not listed go with the only triangle that needs them.
  EXPECT_TRUE(read("3 0 1\n" + balls + "f 0 1 2 1\n").edges.empty());
  // Listed twice, deleted once: it is there.
  EXPECT_EQ(read("3 2 0\n" + balls + "e 0 1 0 1\ne 1 0 2 0\n").edges.size(), 1u);
}

TEST_F(MaFile, KeepsFlagsAndWritesThemAsMatfpReadsThem) {
  std::ofstream(file_, std::ios::binary) << kMatfp;
  const FlaggedMedialMesh flagged = read_flagged_ma(file_);
  EXPECT_EQ(flagged.vertices, (std::vector<CellFlags>{{2, false}, {3, false}, {-1, false}, {2, true}}));
  EXPECT_EQ(flagged.edges, (std::vector<CellFlags>{{1, false}, {2, false}, {0, false}, {0, false}}));
  EXPECT_EQ(to_ma(flagged), kMatfp);
}

FlaggedMedialMesh random_flagged(Random& random) {
  FlaggedMedialMesh flagged;
  const Index count = 3 + static_cast<Index>(random.below(12));
  for (Index i = 0; i < count; ++i) {
    flagged.mesh.centers.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), i);
    flagged.mesh.radii.push_back(random.uniform());
  }
  const auto pick = [&] { return static_cast<Index>(random.below(count)); };
  for (std::uint64_t i = random.below(12); i > 0; --i) {
    if (const std::array<Index, 2> edge{pick(), pick()}; edge[0] != edge[1]) flagged.mesh.edges.push_back(edge);
  }
  for (std::uint64_t i = random.below(12); i > 0; --i) {
    const std::array<Index, 3> corners{pick(), pick(), pick()};
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      flagged.mesh.triangles.push_back(corners);
  }
  complete(flagged.mesh);
  const auto flags = [&](std::size_t cells, bool typed) {
    std::vector<CellFlags> result(cells);
    for (CellFlags& own : result) own = {typed ? static_cast<int>(random.below(14)) - 1 : 0, random.below(4) == 0};
    return result;
  };
  flagged.vertices = flags(count, true);
  flagged.vertices[pick()].deleted = false;
  flagged.edges = flags(flagged.mesh.edges.size(), true);
  flagged.triangles = flags(flagged.mesh.triangles.size(), false);
  return flagged;
}

TEST_F(MaFile, GivesBackEveryFlag) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed, 6);
    const FlaggedMedialMesh flagged = random_flagged(random);
    std::ofstream(file_, std::ios::binary) << to_ma(flagged);
    const FlaggedMedialMesh back = read_flagged_ma(file_);
    ASSERT_EQ(back.mesh.centers, flagged.mesh.centers) << "seed " << seed;
    ASSERT_EQ(back.mesh.edges, flagged.mesh.edges) << "seed " << seed;
    ASSERT_EQ(back.mesh.triangles, flagged.mesh.triangles) << "seed " << seed;
    ASSERT_EQ(back.vertices, flagged.vertices) << "seed " << seed;
    ASSERT_EQ(back.edges, flagged.edges) << "seed " << seed;
    ASSERT_EQ(back.triangles, flagged.triangles) << "seed " << seed;
    ASSERT_EQ(to_ma(back), to_ma(flagged)) << "seed " << seed;
  }
}

// By the definition, cell by cell: a cell counts if no cell in its closure is deleted. Cells are told by their corners'
// heights, which are the vertices' numbers.
TEST_F(MaFile, CountsWhatHasNothingDeletedInItsClosure) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 7);
    const FlaggedMedialMesh flagged = random_flagged(random);
    std::ofstream(file_, std::ios::binary) << to_ma(flagged);
    const MedialMesh mesh = read_ma(file_);
    validate(mesh);
    std::set<std::set<double>> deleted, expected, found;
    const auto sort_out = [&](const auto& cells, const std::vector<CellFlags>& flags) {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        std::set<double> corners(cells[i].begin(), cells[i].end());
        (flags[i].deleted ? deleted : expected).insert(corners);
      }
    };
    std::vector<std::array<Index, 1>> vertices;
    for (Index i = 0; i < flagged.mesh.size(); ++i) vertices.push_back({i});
    sort_out(vertices, flagged.vertices);
    sort_out(flagged.mesh.edges, flagged.edges);
    sort_out(flagged.mesh.triangles, flagged.triangles);
    std::erase_if(expected, [&](const std::set<double>& cell) {
      return std::any_of(deleted.begin(), deleted.end(), [&](const std::set<double>& gone) {
        return std::includes(cell.begin(), cell.end(), gone.begin(), gone.end());
      });
    });
    const auto heights = [&](const auto& cells) {
      for (const auto& corners : cells) {
        std::set<double> cell;
        for (const Index corner : corners) cell.insert(mesh.centers[corner].z());
        found.insert(cell);
      }
    };
    for (const Point& center : mesh.centers) found.insert({center.z()});
    heights(mesh.edges);
    heights(mesh.triangles);
    ASSERT_EQ(found, expected) << "seed " << seed << "\n" << to_ma(flagged);
  }
}

TEST_F(MaFile, WithoutFlagsIsReadAndWrittenWithoutThem) {
  const std::string text = "3 3 1\nv 0 0 0 1\nv 1 0 0 1\nv 0 1 0 0.001\ne 0 1\ne 0 2\ne 1 2\nf 0 1 2\n";
  std::ofstream(file_, std::ios::binary) << text;
  const FlaggedMedialMesh plain = read_flagged_ma(file_);
  EXPECT_TRUE(plain.vertices.empty() && plain.edges.empty() && plain.triangles.empty());
  EXPECT_EQ(to_ma(plain), text);
  EXPECT_EQ(to_ma(read_ma(file_)), text);
  // Text that is no flags means nothing, as ever.
  const std::string more = "3 1 1\nv 0 0 0 1 0.5 1\nv 1 0 0 1 red 1\nv 0 1 0 0.001 1 1 1\ne 0 1 # 1 1\nf 0 1 2 1 1\n";
  EXPECT_EQ(to_ma(read(more)), text);
  EXPECT_TRUE(read_flagged_ma(file_).vertices.empty());
}

TEST_F(MaFile, ThatIsDamagedIsRefusedByNameAndLine) {
  EXPECT_NE(fault("").find("is empty"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 0 zero 1\n").find("line 2"), std::string::npos);
  EXPECT_NE(fault("2 0 0\nv 0 0 0 1\n").find("cut off"), std::string::npos);
  EXPECT_NE(fault("4294967295 0 0\nv 0 0 0 1\n").find("cut off"), std::string::npos);
  EXPECT_NE(fault("1 1 0\nv 0 0 0 1\ne 0 1\n").find("beyond the last vertex"), std::string::npos);
  EXPECT_NE(fault("1 1 0\nv 0 0 0 1\ne 0 0\n").find("twice"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 0 0 -1\n").find("the radius is negative"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 nan 0 1\n").find("not finite"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nx 0 0 0 1\n").find("starts with \"v\""), std::string::npos);
  EXPECT_NE(fault("-1 0 0\n").find("whole number"), std::string::npos);
  EXPECT_NE(fault("2 0 0\nv 0 0 0 1 0 0\nv 0 0 0 1 0 2\n").find("line 3: the flag"), std::string::npos);
  EXPECT_NE(fault("2 1 0\nv 0 0 0 1\nv 0 0 0 1\ne 0 1 0 -1\n").find("line 4: the flag"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 0 0 1 4294967296\n").find("32 bits"), std::string::npos);
  EXPECT_NE(fault("1 0 0\nv 0 0 0 1 0 1\n").find("every vertex is flagged as deleted"), std::string::npos);
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
