#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/structure.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "orchard/geometry/mesh_io.h"

namespace orchard {
namespace {

// Three sheets on one seam, the first of two triangles that end in a sharp edge, and a curve.
MedialMesh seam() {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {1, 1, 0.1}, {3, 0, 0}};
  mesh.radii = {0.5, 0.5, 0, 0.2, 0.3, 0, 1.0 / 3};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {1, 2, 5}};
  mesh.edges = {{1, 6}};
  complete(mesh);
  return mesh;
}

class MedialMeshFormats : public testing::Test {
 protected:
  ~MedialMeshFormats() override { std::filesystem::remove(file_); }
  std::filesystem::path written(const std::string& text, const char* ending) {
    file_.replace_extension(ending);
    std::ofstream(file_, std::ios::binary) << text;
    return file_;
  }

 private:
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("orchard_formats_" + std::to_string(getpid()));
};

TEST_F(MedialMeshFormats, FlagSeamsCurvesAndSharpEdgesAndReadBackTheSame) {
  const MedialMesh mesh = seam();
  const FlaggedMedialMesh flagged = with_feature_flags(mesh);
  ASSERT_EQ(flagged.edges.size(), mesh.edges.size());
  std::map<std::array<Index, 2>, int> types;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) types[mesh.edges[e]] = flagged.edges[e].type;
  for (const auto& [edge, type] : types) {
    const int expected = edge == std::array<Index, 2>{2, 5}                                         ? 2
                         : edge == std::array<Index, 2>{0, 1} || edge == std::array<Index, 2>{1, 6} ? 1
                                                                                                    : 0;
    EXPECT_EQ(type, expected) << edge[0] << ' ' << edge[1];
  }
  for (const CellFlags& vertex : flagged.vertices) EXPECT_EQ(vertex, (CellFlags{-1, false}));

  const FlaggedMedialMesh back = read_flagged_ma(written(to_ma(flagged), ".ma"));
  EXPECT_EQ(back.edges, flagged.edges);
  EXPECT_EQ(back.vertices, flagged.vertices);
  EXPECT_EQ(back.mesh.edges, mesh.edges);
  EXPECT_EQ(back.mesh.triangles, mesh.triangles);
  EXPECT_EQ(back.mesh.radii, mesh.radii);
  EXPECT_EQ(to_ma(back), to_ma(flagged));
}

TEST_F(MedialMeshFormats, CountSheetsUpToSeams) {
  const std::vector<Index> sheet = medial_structure(seam()).of_face;
  EXPECT_EQ(sheet, (std::vector<Index>{0, 1, 2, 0}));
}

TEST_F(MedialMeshFormats, ArePlyThatReadersTakeWithRadiiAndEdges) {
  const MedialMesh mesh = seam();
  const std::string text = to_ply(mesh);
  const TriangleMesh back = read_mesh(written(text, ".ply"));
  EXPECT_EQ(back.vertices.size(), mesh.size());
  EXPECT_EQ(back.triangles.size(), mesh.triangles.size());
  std::istringstream lines(text.substr(text.find("end_header\n") + 11));
  for (Index v = 0; v < mesh.size(); ++v) {
    double x = 0, y = 0, z = 0, radius = 0;
    lines >> x >> y >> z >> radius;
    EXPECT_EQ(Point(x, y, z), mesh.centers[v]);
    EXPECT_EQ(radius, mesh.radii[v]);
  }
  const std::vector<Index> sheet = medial_structure(mesh).of_face;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Index count = 0, own = 0;
    std::array<Index, 3> corners{};
    lines >> count >> corners[0] >> corners[1] >> corners[2] >> own;
    EXPECT_EQ(count, 3U);
    EXPECT_EQ(corners, mesh.triangles[t]);
    EXPECT_EQ(own, sheet[t]);
  }
  for (const auto& edge : mesh.edges) {
    std::array<Index, 2> ends{};
    lines >> ends[0] >> ends[1];
    EXPECT_EQ(ends, edge);
  }
  EXPECT_TRUE(lines && (lines >> std::ws).eof());
}

TEST_F(MedialMeshFormats, AreObjWithAGroupForEachSheetAndOneOfCurves) {
  const std::string text = to_obj(seam());
  for (const char* group :
       {"g sheet0\nf 1 2 3\nf 2 3 6\n", "g sheet1\nf 1 2 4\n", "g sheet2\nf 1 2 5\n", "g curves\nl 2 7\n"})
    EXPECT_NE(text.find(group), std::string::npos) << group << text;
  EXPECT_EQ(read_mesh(written(text, ".obj")).triangles.size(), 4U);
}

}  // namespace
}  // namespace orchard
