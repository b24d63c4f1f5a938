#include "orchard/viz/vtk_writer.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLMultiBlockDataReader.h>
#include <vtkXMLPolyDataReader.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "read_vtk.h"
#include "values.h"

namespace orchard {
namespace {

using test::TestFolder;
using test::values;

std::vector<Point> points_of(vtkPolyData* data) {
  std::vector<Point> result(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < result.size(); ++i) data->GetPoint(static_cast<vtkIdType>(i), result[i].data());
  return result;
}

std::vector<std::vector<Index>> cells_of(vtkPolyData* data) {
  std::vector<std::vector<Index>> result;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) {
    vtkIdList* ids = data->GetCell(i)->GetPointIds();
    result.emplace_back();
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) result.back().push_back(static_cast<Index>(ids->GetId(k)));
  }
  return result;
}

TEST(WriteMesh, KeepsEveryBitOfTheVerticesAndEveryTriangleWithItsCluster) {
  struct Case {
    const char* name;
    TriangleMesh mesh;
  };
  const Case cases[] = {{"box", test::box({0, 0, 0}, {1, 2, 3})},
                        {"offset 1e6, scale 1e-6", test::transformed(test::l_shape(), 1e-6, {1e6, -1e6, 1.0 / 3})},
                        {"open", test::open_box()},
                        {"curved", test::torus(12, 7)}};
  const TestFolder folder;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Surface surface(c.mesh);
    write_mesh(folder / "mesh.vtp", surface);
    const auto data = test::read_poly_data(folder / "mesh.vtp");
    EXPECT_EQ(points_of(data), surface.mesh().vertices);
    const auto triangles = cells_of(data);
    const auto clusters = values(data->GetCellData(), "cluster");
    ASSERT_EQ(triangles.size(), surface.mesh().triangles.size());
    ASSERT_EQ(clusters.size(), triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto& triangle = surface.mesh().triangles[i];
      EXPECT_EQ(triangles[i], std::vector<Index>(triangle.begin(), triangle.end()));
      EXPECT_EQ(clusters[i], surface.clusters().of_triangle[i]);
    }
    EXPECT_EQ(values(data->GetFieldData(), "bounding_radius"), std::vector{surface.bounding_radius()});
  }
}

TEST(WritePoints, KeepsOriginAndTriangleOfEveryPoint) {
  const TestFolder folder;
  const SurfaceSampling sampling = test::corner_sampling(Surface(test::icosphere(1)));
  write_points(folder / "points.vtp", sampling);
  const auto data = test::read_poly_data(folder / "points.vtp");
  EXPECT_EQ(points_of(data), sampling.points);
  const auto origins = values(data->GetPointData(), "origin");
  const auto triangles = values(data->GetPointData(), "triangle");
  ASSERT_EQ(data->GetNumberOfVerts(), sampling.size());
  ASSERT_EQ(origins.size(), sampling.size());
  ASSERT_EQ(triangles.size(), sampling.size());
  for (Index i = 0; i < sampling.size(); ++i) {
    EXPECT_EQ(origins[i], static_cast<double>(sampling.origins[i]));
    EXPECT_EQ(triangles[i], sampling.triangles[i]);
  }
}

TEST(WriteMedialAxis, MakesThreeFilesThatNumberTheVerticesAlike) {
  const TestFolder folder;
  const MedialAxis axis = test::small_axis();
  write_medial_axis(folder / "axis", axis);
  for (const char* name : {"axis-vertices.vtp", "axis-edges.vtp", "axis-faces.vtp"}) {
    SCOPED_TRACE(name);
    const auto data = test::read_poly_data(folder / name);
    EXPECT_EQ(points_of(data), axis.centers);
    EXPECT_EQ(values(data->GetPointData(), "radius"), axis.radii);
    EXPECT_EQ(values(data->GetPointData(), "valence"), (std::vector<double>{2, 1, 1, 0}));
    const auto component = values(data->GetPointData(), "component");
    EXPECT_EQ(component[0], component[1]);
    EXPECT_EQ(component[0], component[2]);
    EXPECT_NE(component[0], component[3]);
  }
  EXPECT_EQ(test::read_poly_data(folder / "axis-vertices.vtp")->GetNumberOfVerts(), 4);
  const auto contacts = test::read_poly_data(folder / "axis-contacts.vtp");
  EXPECT_EQ(points_of(contacts), axis.points);
  EXPECT_EQ(values(contacts->GetPointData(), "origin"), (std::vector<double>{0, 2}));
}

TEST(WriteMedialAxis, HasALinePerPairOfNeighboursAndAPolygonPerFace) {
  const TestFolder folder;
  write_medial_axis(folder / "axis", test::small_axis());
  EXPECT_EQ(cells_of(test::read_poly_data(folder / "axis-edges.vtp")),
            (std::vector<std::vector<Index>>{{0, 1}, {0, 2}}));
  const auto faces = test::read_poly_data(folder / "axis-faces.vtp");
  EXPECT_EQ(cells_of(faces), (std::vector<std::vector<Index>>{{0, 1, 2}}));
  EXPECT_EQ(values(faces->GetCellData(), "point_a"), std::vector<double>{0});
  EXPECT_EQ(values(faces->GetCellData(), "point_b"), std::vector<double>{1});
  // From (1/6, 1/6, 0) the points (0, 0, 1) and (0, 0, -1).
  const auto angle = values(faces->GetCellData(), "contact_angle");
  ASSERT_EQ(angle.size(), 1u);
  EXPECT_NEAR(angle[0], 2 * std::atan(1 / (std::sqrt(2.0) / 6)) * 180 / std::numbers::pi, 1e-10);
}

// The ancestor of a node, or the node itself, that stands for it on a level.
Index standing_for(const SphereTree& tree, Index node, Index level) {
  while (tree.nodes[node].level > level) node = tree.nodes[node].parent;
  return node;
}

TEST(WriteTreeLevel, ShowsForEveryLeafExactlyTheNodeOfItsPathThatStandsForItThere) {
  const TestFolder folder;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SphereTree tree = test::random_tree(seed, 4);
    for (Index level = 0; level <= tree.depth() + 1; ++level) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", level " + std::to_string(level));
      std::set<Index> expected;
      for (Index i = 0; i < tree.nodes.size(); ++i) {
        if (tree.nodes[i].child_count == 0) expected.insert(standing_for(tree, i, level));
      }
      write_tree_level(folder / "level.vtp", tree, level);
      const auto data = test::read_poly_data(folder / "level.vtp");
      const auto nodes = values(data->GetPointData(), "node");
      EXPECT_EQ(nodes, std::vector<double>(expected.begin(), expected.end()));
      EXPECT_EQ(data->GetNumberOfVerts(), static_cast<vtkIdType>(expected.size()));
    }
  }
}

TEST(WriteTreeLevel, CarriesTheFiguresOfEachNode) {
  const TestFolder folder;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const SphereTree tree = test::random_tree(seed, 3);
    const Index level = 2;
    write_tree_level(folder / "level.vtp", tree, level);
    const auto data = test::read_poly_data(folder / "level.vtp");
    const auto centers = points_of(data);
    vtkPointData* arrays = data->GetPointData();
    const auto nodes = values(arrays, "node");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto index = static_cast<Index>(nodes[i]);
      const SphereNode& node = tree.nodes[index];
      EXPECT_EQ(centers[i], node.sphere.center);
      EXPECT_EQ(values(arrays, "radius")[i], node.sphere.radius);
      EXPECT_EQ(values(arrays, "error")[i], node.distance_bound);
      EXPECT_EQ(values(arrays, "inaccuracy")[i], node.inaccuracy);
      EXPECT_EQ(values(arrays, "level")[i], node.level);
      EXPECT_EQ(values(arrays, "parent")[i], node.parent);
      EXPECT_EQ(values(arrays, "carried")[i], node.level < level ? 1 : 0);
      const Index child_of_root = standing_for(tree, index, 1);
      EXPECT_EQ(values(arrays, "branch")[i], child_of_root - tree.nodes[0].first_child);
    }
  }
}

TEST(WriteTreeLevel, SaysNaNForWhatIsNotKnown) {
  const TestFolder folder;
  SphereTree tree = test::random_tree(1, 1);
  tree.nodes[1].distance_bound = tree.nodes[1].inaccuracy = std::numeric_limits<double>::infinity();
  write_tree_level(folder / "level.vtp", tree, 1);
  for (const char* name : {"error", "inaccuracy"}) {
    const auto all = values(test::read_poly_data(folder / "level.vtp")->GetPointData(), name);
    EXPECT_TRUE(std::isnan(all.front())) << name;
    for (std::size_t i = 1; i < all.size(); ++i) EXPECT_TRUE(std::isfinite(all[i])) << name;
  }
}

TEST(WriteTreeLevel, GivesTheRootNoParentAndNoBranch) {
  const TestFolder folder;
  write_tree_level(folder / "level.vtp", test::random_tree(1, 2), 0);
  const auto data = test::read_poly_data(folder / "level.vtp");
  EXPECT_EQ(values(data->GetPointData(), "parent"), std::vector<double>{-1});
  EXPECT_EQ(values(data->GetPointData(), "branch"), std::vector<double>{-1});
}

TEST(Writers, MakeReadableFilesOfEmptyValues) {
  const TestFolder folder;
  write_points(folder / "points.vtp", {});
  write_tree_level(folder / "level.vtp", {}, 0);
  write_medial_axis(folder / "axis", {});
  for (const char* name : {"points.vtp", "level.vtp", "axis-vertices.vtp", "axis-edges.vtp", "axis-faces.vtp"}) {
    EXPECT_EQ(test::read_poly_data(folder / name)->GetNumberOfPoints(), 0) << name;
  }
}

TEST(Writers, ThrowAndLeaveNothingWhereTheFolderIsMissing) {
  const TestFolder folder;
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_THROW(write_mesh(folder / "none/mesh.vtp", surface), Error);
  EXPECT_THROW(write_points(folder / "none/points.vtp", {}), Error);
  EXPECT_THROW(write_medial_axis(folder / "none/axis", {}), Error);
  EXPECT_THROW(write_tree_level(folder / "none/level.vtp", {}, 0), Error);
  EXPECT_THROW(write_multiblock(folder / "none/all.vtm", {}), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteMultiblock, OpensEveryFileUnderItsName) {
  const TestFolder folder;
  write_points(folder / "a.vtp", test::corner_sampling(Surface(test::open_box())));
  write_tree_level(folder / "b.vtp", test::random_tree(1, 2), 0);
  const NamedFile files[] = {{"<points> & \"more\"", "a.vtp"}, {"root", "b.vtp"}};
  write_multiblock(folder / "all.vtm", files);

  vtkNew<vtkXMLMultiBlockDataReader> reader;
  reader->SetFileName((folder / "all.vtm").c_str());
  reader->Update();
  auto* blocks = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  ASSERT_NE(blocks, nullptr);
  ASSERT_EQ(blocks->GetNumberOfBlocks(), 2u);
  EXPECT_STREQ(blocks->GetMetaData(0u)->Get(vtkCompositeDataSet::NAME()), "<points> & \"more\"");
  EXPECT_STREQ(blocks->GetMetaData(1u)->Get(vtkCompositeDataSet::NAME()), "root");
  EXPECT_EQ(vtkPolyData::SafeDownCast(blocks->GetBlock(0))->GetNumberOfPoints(), 10);
  EXPECT_EQ(vtkPolyData::SafeDownCast(blocks->GetBlock(1))->GetNumberOfPoints(), 1);
}

struct AllValues {
  Surface surface{test::box({-1, -1, -1}, {1, 1, 1})};
  SurfaceSampling sampling = test::corner_sampling(surface);
  MedialAxis axis = test::small_axis();
  SphereTree tree = test::random_tree(3, 2);
  PipelineValues pointers() const { return {&surface, &sampling, &axis, &tree}; }
};

TEST(WritePipeline, WritesWhatThereIsAndListsIt) {
  const TestFolder folder;
  const AllValues all;
  const auto files = write_pipeline(folder / "l.v2-build", all.pointers());
  ASSERT_EQ(files.size(), 5u + all.tree.depth() + 1);
  for (const NamedFile& file : files) {
    EXPECT_TRUE(std::filesystem::exists(folder / file.file.string())) << file.file;
    EXPECT_TRUE(file.file.string().starts_with("l.v2-build-")) << file.file;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "l.v2-build.vtm"));

  const auto fewer = write_pipeline(folder / "octree", {.surface = &all.surface, .tree = &all.tree});
  EXPECT_EQ(fewer.size(), 1u + all.tree.depth() + 1);
  EXPECT_FALSE(std::filesystem::exists(folder / "octree-points.vtp"));
  EXPECT_TRUE(write_pipeline(folder / "nothing", {}).empty());
}

TEST(WritePipeline, KeepsTwoRunsInAFolderApart) {
  const TestFolder folder;
  const AllValues all;
  write_pipeline(folder / "a", all.pointers());
  const std::string before = test::bytes_of(folder / "a-mesh.vtp");
  const Surface other(test::icosphere(1));
  write_pipeline(folder / "b", {.surface = &other});
  EXPECT_EQ(test::bytes_of(folder / "a-mesh.vtp"), before);
  EXPECT_NE(test::bytes_of(folder / "b-mesh.vtp"), before);
}

TEST(WritePipeline, WritesTheSameBytesForTheSameValues) {
  const TestFolder folder;
  for (const char* name : {"first", "second"}) {
    std::filesystem::create_directory(folder / name);
    write_pipeline(folder / name / "l", AllValues().pointers());
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / "first")) {
    const std::string bytes = test::bytes_of(entry.path());
    EXPECT_FALSE(bytes.empty()) << entry.path();
    EXPECT_EQ(bytes, test::bytes_of(folder / "second" / entry.path().filename())) << entry.path();
  }
}

}  // namespace
}  // namespace orchard
