#include "orchard/medial/read_axis.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>

#include "../geometry/expect_input_error.h"
#include "formats/axis_text.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/structure.h"
#include "orchard/medial/topology.h"
#include "support/corpus.h"
#include "support/shapes.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;
using test::expect_input_error;

// A folder of its own, with files in it.
class ReadAxis : public testing::Test {
 protected:
  ReadAxis() : folder_(fs::temp_directory_path() / ("orchard_axes_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~ReadAxis() override { fs::remove_all(folder_); }
  fs::path add(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  ForeignAxis read(const std::string& name, const std::string& text) const { return read_axis(add(name, text)); }
  // Refused, with the file's name and these words.
  void refuses(const std::string& name, const std::string& text, const std::string& words) const {
    const fs::path file = add(name, text);
    expect_input_error([&] { read_axis(file); }, {words, name});
  }
  fs::path folder_;
};

// A triangle and a curve at its last corner.
void expect_kite(const MedialMesh& mesh) {
  EXPECT_EQ(mesh.size(), 4u);
  EXPECT_EQ(mesh.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}, {1, 2}, {2, 3}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}}));
}

const char* const kHeadless = "v 0 0 0 .5\nv 1 0 0 .25\nv 0 1 0 .5\nv 0 3 0 .125\n";

TEST_F(ReadAxis, TakesTheMaOfQmatAndMatfpWithAndWithoutFlags) {
  const std::string balls = kHeadless;
  const ForeignAxis plain = read("a.ma", "4 4 1\n" + balls + "e 0 1\ne 0 2\ne 1 2\ne 2 3\nf 0 1 2\n");
  expect_kite(plain.mesh);
  EXPECT_TRUE(plain.has_radii);
  EXPECT_TRUE(plain.notes.empty());
  EXPECT_EQ(plain.mesh.radii, (std::vector<double>{.5, .25, .5, .125}));
  const ForeignAxis flagged = read("b.ma",
                                   "5 4 1\nv 0 0 0 .5 2 0\nv 1 0 0 .25 2 0\nv 0 1 0 .5 2 0\nv 9 9 9 0 -1 1\n"
                                   "v 0 3 0 .125 1 0\ne 0 1 0 0\ne 0 2 0 0\ne 1 2 0 0\ne 2 4 2 0\nf 0 1 2 0\n");
  expect_kite(flagged.mesh);
  EXPECT_EQ(flagged.notes.size(), 1u);
}

TEST_F(ReadAxis, TakesTheMaDupOfMattopoWithItsImportancesCopiesAndTetrahedra) {
  const ForeignAxis axis =
      read("a.ma_dup",
           "5 5 2 1\nv 0 0 0 .5 2 0 1\nv 1 0 0 .25 2 0 1\nv 0 1 0 .5 2 0 1\nv 0 3 0 .125 2 0 1\nv 5 5 5 1 2 1 0\n"
           "e 0 1 0 0 1\ne 0 2 0 0 1\ne 1 2 0 0 1\ne 2 3 1 0 2\ne 1 3 0 1 1\n"
           "f 0 1 2 0.750000000000000 0 1\nf 1 2 3 1.000000000000000 1 1\nt 0 1 2 3 1 1\n");
  expect_kite(axis.mesh);
  refuses("b.ma_dup", "4 0 1 0\nv 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nv 0 0 1 1\nf 0 1 2 0.5 7 1\n", "neither 0 nor 1");
  const ForeignAxis solid = read("c.ma_dup",
                                 "4 0 1 1\nv 0 0 0 1 2 0 1\nv 1 0 0 1 2 0 1\nv 0 1 0 1 2 0 1\nv 0 0 1 1 2 0 1\n"
                                 "f 0 1 2 0 0 1\nt 0 1 2 3 0 1\n");
  EXPECT_NE(solid.notes.front().find("1 tetrahedra"), std::string::npos);
}

TEST_F(ReadAxis, TakesTheStructureOfMatstructWhereverItsLinesBreak) {
  const std::string mesh = "4 4 1\n" + std::string(kHeadless) + "e 2 3\ne 1 2\ne 0 2\ne 0 1\nf 2 1 0\n";
  const std::string structure = "3\n0 0 1\n0 \n7 2 3\n1 2 3 \n9 3 1\n2 \n";
  const ForeignAxis axis = read("a.ma", mesh + structure);
  ASSERT_EQ(axis.structure.size(), 3u);
  // Edges are renumbered as they are sorted.
  EXPECT_EQ(axis.structure[1], (StructurePart{7, 2, {0, 1, 2}}));
  EXPECT_EQ(axis.structure[2], (StructurePart{9, 3, {2}}));
  refuses("b.ma", mesh + "1\n0 0 1\n1\n", "names a cell beyond the last one");
  refuses("c.ma", mesh + "1\n0 9 1\n0\n", "the kind of the part");
  refuses("d.ma", mesh + "2\n0 0 1\n0\n", "may be cut off");
}

TEST_F(ReadAxis, ReadsTheStructureThatItWrites) {
  const MedialMesh mesh =
      read("a.ma", "4 4 1\n" + std::string(kHeadless) + "e 2 3\ne 0 1\ne 0 2\ne 1 2\nf 0 1 2\n").mesh;
  const MedialStructure structure = medial_structure(mesh);
  const ForeignAxis again = read("b.ma", to_ma(mesh) + to_structure_section(structure));
  EXPECT_EQ(again.mesh.edges, mesh.edges);
  ASSERT_EQ(again.structure.size(), structure.parts.size());
  EXPECT_EQ(to_structure_section(again.structure), to_structure_section(structure));
}

TEST_F(ReadAxis, TakesObjWithLinesAndPolygonsAndRadiiIfEveryVertexHasOne) {
  const ForeignAxis axis =
      read("a.obj", "# made by hand\no x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 3 0\nvt 0 0\nf 1/1 2/1 -2/1\nl 3 4\n");
  expect_kite(axis.mesh);
  EXPECT_FALSE(axis.has_radii);
  const ForeignAxis balls = read("b.obj", std::string(kHeadless) + "f 1 2 3\nl 4 3\n");
  expect_kite(balls.mesh);
  EXPECT_TRUE(balls.has_radii);
  EXPECT_EQ(balls.mesh.radii[1], .25);
  EXPECT_FALSE(read("c.obj", "v 0 0 0 1\nv 1 0 0 1\nl 1 2\n").has_radii) << "1 is the weight of OBJ";
  EXPECT_EQ(
      read("d.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 9 9\nv 1 1 0 1 1 1\nv 0 1 0 0 0 0\nf 1 2 3 4\n").mesh.triangles.size(),
      2u);
}

TEST_F(ReadAxis, TakesBallsAsTextWithOrWithoutAWordInFront) {
  EXPECT_EQ(read("a.txt", kHeadless).mesh.radii, (std::vector<double>{.5, .25, .5, .125}));
  EXPECT_EQ(read("b.xyzr", "2\n0 0 0 1\n1 0 0 .5\n").mesh.radii, (std::vector<double>{1, .5}));
  EXPECT_FALSE(read("c.xyz", "0,0,0\n1;0;0\n").has_radii);
}

TEST_F(ReadAxis, TakesTheBallsOfMatfpsSphFiles) {
  const ForeignAxis axis = read("a.sph", "4 3\n0 0 0 1 2 0 1\n1 0 0 .5 2 0 1\n9 9 9 9 2 1 0\n");
  EXPECT_EQ(axis.mesh.radii, (std::vector<double>{1, .5}));
  EXPECT_EQ(axis.notes.size(), 1u);
  EXPECT_FALSE(read("b.sph", "3 2\n0 0 0\n1 0 0\n").has_radii);
}

TEST_F(ReadAxis, TakesPlyWithAndWithoutRadiiInBothEncodings) {
  const ForeignAxis text = read("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                "property float z\nproperty float radius\nelement face 1\nproperty list uchar int "
                                "vertex_indices\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
                                "end_header\n0 0 0 .5\n1 0 0 .25\n0 1 0 .5\n0 3 0 .125\n3 2 1 0\n2 3\n");
  expect_kite(text.mesh);
  EXPECT_EQ(text.mesh.radii[3], .125);
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
  const float places[] = {0, 0, 0, 1, 2, 3};
  const std::int32_t ends[] = {0, 1};
  binary.append(reinterpret_cast<const char*>(places), sizeof places);
  binary.append(reinterpret_cast<const char*>(ends), sizeof ends);
  const ForeignAxis axis = read("b.ply", binary);
  EXPECT_FALSE(axis.has_radii);
  EXPECT_EQ(axis.mesh.centers[1], Point(1, 2, 3));
  EXPECT_EQ(axis.mesh.edges.size(), 1u);
  refuses("c.ply", binary.substr(0, binary.size() - 1), "byte ");
}

TEST_F(ReadAxis, ReadsThePlyThatItWritesToTheLastBit) {
  MedialMesh mesh = read("a.ma", "4 1 1\n" + std::string(kHeadless) + "e 2 3\nf 0 1 2\n").mesh;
  mesh.radii[0] = 0.1;
  const ForeignAxis again = read("b.ply", to_ply(mesh));
  EXPECT_EQ(again.mesh.centers, mesh.centers);
  EXPECT_EQ(again.mesh.radii, mesh.radii);
  EXPECT_EQ(again.mesh.edges, mesh.edges);
  EXPECT_EQ(again.mesh.triangles, mesh.triangles);
  const ForeignAxis obj = read("c.obj", to_obj(mesh));
  EXPECT_EQ(obj.mesh.edges, mesh.edges);
  EXPECT_EQ(obj.mesh.centers, mesh.centers);
}

TEST_F(ReadAxis, TakesTheFilesOfPoint2SkeletonAsOneWhicheverIsNamed) {
  add("7_center.off", "OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 3 0\n");
  add("7_skel_face.obj", "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 0.0 1.0 0.0\nv 0.0 3.0 0.0\nf 1 2 3\n");
  add("7_skel_edge.obj", "v 0.0 0.0 0.0\nv 1.0 0.0 0.0\nv 0.0 1.0 0.0\nv 0.0 3.0 0.0\nl 3 4\n");
  for (const char* name : {"7_center.off", "7_skel_face.obj", "7_skel_edge.obj"}) {
    const ForeignAxis axis = read_axis(folder_ / name);
    expect_kite(axis.mesh);
    EXPECT_EQ(axis.files.size(), 3u);
    EXPECT_FALSE(axis.has_radii);
  }
  std::string spheres;
  const double centers[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 3, 0}};
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 6; ++k) {
      double at[3] = {centers[i][0], centers[i][1], centers[i][2]};
      at[k / 2] += (k % 2 == 0 ? -1 : 1) * 0.25 * (i + 1);
      spheres += "v " + std::to_string(at[0]) + ' ' + std::to_string(at[1]) + ' ' + std::to_string(at[2]) + '\n';
    }
  }
  add("7_sphere.obj", spheres);
  const ForeignAxis axis = read_axis(folder_ / "7_center.off");
  EXPECT_TRUE(axis.has_radii);
  EXPECT_EQ(axis.mesh.radii, (std::vector<double>{.25, .5, .75, 1}));
  add("7_skel_edge.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  expect_input_error([&] { read_axis(folder_ / "7_center.off"); }, {"7_skel_edge.obj", "2 vertices"});
}

TEST_F(ReadAxis, TakesAnOffWithoutFacesAndTheObjOfItsNameAsAPair) {
  add("m-point2skeleton-4.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 3 0\nf 1 2 3\nl 3 4\n");
  expect_kite(read("m-point2skeleton-4.off", "OFF 4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 3 0\n").mesh);
  EXPECT_EQ(read("alone.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n").mesh.triangles.size(), 1u);
}

TEST_F(ReadAxis, TakesStructureGraphs) {
  const ForeignAxis swc = read("a.swc", "# neuron\n10 1 0 0 0 1.5 -1\n11 3 1 0 0 1 10\n12 3 2 0 0 .5 11\n");
  EXPECT_EQ(swc.mesh.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {1, 2}}));
  EXPECT_EQ(swc.mesh.radii[0], 1.5);
  const ForeignAxis cg = read("b.cg", "# D:3 NV:2 NE:1\nv 0 0 0\nv 1 0 0\ne 1 2\n");
  EXPECT_EQ(cg.mesh.edges.size(), 1u);
  const ForeignAxis lines = read("c.polylines.txt", "3 0 0 0 1 0 0 2 0 0\n2 1 0 0 1 1 0\n");
  EXPECT_EQ(lines.mesh.size(), 4u);
  EXPECT_EQ(lines.mesh.edges.size(), 3u);
}

TEST_F(ReadAxis, NamesFileAndLineOfWhatIsWrong) {
  refuses("a.ma", "2 1 0\nv 0 0 0 1\nv 1 0 0 -1\ne 0 1\n", "line 3: the radius is negative");
  refuses("b.ma", "2 1 0\nv 0 0 0 1\nv 1 0 0 nan\ne 0 1\n", "line 3");
  refuses("c.ma", "2 1 0\nv 0 0 0 1\nv 1 0 0 1\ne 0 2\n", "line 4: a vertex number is beyond");
  refuses("d.ma", "2 1 0\nv 0 0 0 1\nv 1 0", "line 3");
  refuses("a.obj", "v 0 0 0\nf 1 2 3\n", "line 2: the vertex number is beyond");
  refuses("b.obj", "v 0 0 nan\n", "line 1: the number is not finite");
  refuses("c.obj", "v 0 0 0 1\nv 0 0 1 -2\n", "line 2: the radius is negative");
  refuses("d.obj", "v 0 0 0 1\nv 0 0 1\n", "line 2: the vertex has no radius, but others have one");
  refuses("e.obj", "ply\nformat ascii 1.0\n", "line 1: this is no line of an .obj file");
  refuses("f.obj", "v 0 0 0\nv 1 0 0\nl 1 1\n", "line 3: the line or face names a vertex twice");
  refuses("a.txt", "v 0 0 0 1\nv 0 0 0\n", "line 2: expected 4 numbers");
  refuses("b.txt", "0 0 0 -1\n", "line 1: the radius is negative");
  refuses("c.txt", "3\n0 0 0 1\n", "may be cut off");
  refuses("d.txt", "some words\n", "line 1: expected");
  refuses("e.txt", "0 0 0 inf\n", "line 1");
  refuses("a.sph", "4 2\n0 0 0 1\n", "may be cut off");
  refuses("b.sph", "4 1\n0 0 0 -1\n", "line 2: the radius is negative");
  refuses("c.sph", "8 2\n0 0 0 1\n", "a sphere-tree is no axis");
  refuses("d.sph", "4 1\n0 0 0 1\n0 0 0 1\n", "more lines");
  refuses("a.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 2\n", "beyond the last vertex");
  refuses("b.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n", "may be cut off");
  refuses("c.off", "COFF\n1 0 0\n0 0 0\n", "begins with \"OFF\"");
  refuses("a.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 3\n", "line 2: the parent");
  refuses("c.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 -3\n", "line 2: the parent is no node");
  refuses("b.swc", "1 1 0 0 0 -1 -1\n", "line 1: the radius is negative");
  refuses("a.polylines.txt", "3 0 0 0 1 0 0\n", "line 1");
  refuses("a.stl", "solid\n", "is no format of medial axes that can be read");
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty float r\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
      "end_header\n";
  refuses("a.ply", head + "0 0 0 -1\n0 0\n", "line 12: the radius is negative");
  refuses("b.ply", head + "0 0 nan 1\n0 0\n", "line 12: a coordinate is not finite");
  refuses("c.ply", head + "0 0 0 1\n0 1\n", "line 13: a vertex number is not from 0 to 0");
  refuses("d.ply", head + "0 0 0 1\n", "ends before the rows");
  refuses("e.ply", "OFF\n", "e.ply");
  expect_input_error([&] { read_axis(folder_ / "none.ma"); }, {"none.ma"});
  expect_input_error([&] { read_axis(folder_); }, {folder_.string()});
}

// Every reader gives a valid mesh, or an InputError of one line, whatever is done to its bytes.
TEST_F(ReadAxis, SurvivesRandomDamageOfEveryKind) {
  const std::map<std::string, std::string> files{
      {"a.ma", "4 4 1\n" + std::string(kHeadless) + "e 2 3\ne 1 2\ne 0 2\ne 0 1\nf 2 1 0\n1\n0 2 3 1 2 3\n"},
      {"a.ma_dup",
       "3 1 1 1\nv 0 0 0 1 2 0 1\nv 1 0 0 1 2 0 1\nv 0 1 0 1 2 0 1\ne 0 1 0 0 1\nf 0 1 2 .5 0 1\nt 0 1 2 0 0 1\n"},
      {"a.obj", std::string(kHeadless) + "f 1 2 3\nl 4 3\n"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"a.sph", "4 2\n0 0 0 1 2 0 1\n1 0 0 .5 2 0 1\n"},
      {"a.swc", "1 1 0 0 0 1 -1\n2 1 1 0 0 1 1\n"},
      {"a.polylines.txt", "3 0 0 0 1 0 0 2 0 0\n"},
      {"a.txt", kHeadless},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
       "property float r\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
       "0 0 0 1\n1 0 0 1\n2 0 1\n"}};
  std::uint64_t item = 0;
  for (const auto& [name, text] : files) {
    for (int trial = 0; trial < 60; ++trial) {
      Random random(3, 1, item++);
      const test::Bytes bytes = test::damaged({text.begin(), text.end()}, random);
      try {
        validate(read(name, {bytes.begin(), bytes.end()}).mesh);
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

// A box's axis in few cells: enough for frames.
MedialMesh rod(const Vector& offset, double scale) {
  MedialMesh mesh;
  for (int i = 0; i <= 8; ++i) {
    mesh.centers.push_back(scale * Point(1 + 0.5 * i, 1, 1) + offset);
    mesh.radii.push_back(scale);
    if (i > 0) mesh.edges.push_back({static_cast<Index>(i - 1), static_cast<Index>(i)});
  }
  return mesh;
}

TEST(PlaceAxis, FindsRadiiAsDistancesAndSaysSo) {
  const Surface surface(test::box({0, 0, 0}, {6, 2, 2}));
  ForeignAxis axis{.mesh = rod(Vector::Zero(), 1), .has_radii = false};
  axis.mesh.radii.assign(axis.mesh.radii.size(), 0);
  const PlacedAxis placed = place_axis(surface, axis);
  for (const double radius : placed.mesh.radii) EXPECT_DOUBLE_EQ(radius, 1);
  EXPECT_TRUE(placed.radii_found);
  EXPECT_NE(placed.notes.front().find("no radii"), std::string::npos);
}

TEST(PlaceAxis, SaysWhichFrameWouldFit) {
  const Surface surface(test::box({0, 0, 0}, {6, 2, 2}));
  EXPECT_NO_THROW(place_axis(surface, {.mesh = rod(Vector::Zero(), 1)}));
  // As a program that scales the mesh to a longest side of 10 has it.
  expect_input_error([&] { place_axis(surface, {.mesh = rod(Vector::Zero(), 10.0 / 6)}); },
                     {"another frame", "scaled by 0.6 and then moved by (0, 0, 0)"});
  expect_input_error(
      [&] {
        place_axis(surface, {.mesh = rod({100, 0, 0}, 1)});
      },
      {"another frame", "scaled by 1 and then moved by (-100, 0, 0)"});
  MedialMesh turned = rod(Vector::Zero(), 1);
  for (Point& center : turned.centers) center = Point(center.x(), -center.z() - 7, center.y());
  expect_input_error([&] { place_axis(surface, {.mesh = turned}); }, {"another frame"});
}

TEST(PlaceAxis, TakesACoarseAxisWhoseBallsAreFarTooLarge) {
  const Surface surface(test::box({0, 0, 0}, {6, 2, 2}));
  MedialMesh coarse = rod(Vector::Zero(), 1);
  for (std::size_t i = 0; i < coarse.radii.size(); ++i) coarse.radii[i] = 1.45 + 0.01 * static_cast<double>(i);
  EXPECT_NO_THROW(place_axis(surface, {.mesh = coarse}));
}

TEST(PlaceAxis, RefusesTheSurfaceItselfWithRadiusOne) {
  const Surface surface(test::icosphere(2, 3));
  MedialMesh mesh;
  mesh.centers = surface.mesh().vertices;
  mesh.triangles = {surface.mesh().triangles.begin(), surface.mesh().triangles.end()};
  mesh.radii.assign(mesh.centers.size(), 1);
  for (auto& triangle : mesh.triangles) std::sort(triangle.begin(), triangle.end());
  complete(mesh);
  expect_input_error([&] { place_axis(surface, {.mesh = mesh}); }, {"the input surface with radius 1"});
  for (Point& center : mesh.centers) center = (center + Point(3, 3, 3)) * 10 / 6;
  expect_input_error([&] { place_axis(surface, {.mesh = mesh}); }, {"the input surface with radius 1"});
  expect_input_error([&] { place_axis(surface, {.mesh = mesh, .has_radii = false}); },
                     {"its vertices lie on the mesh"});
}

TEST(ConnectBalls, GivesTheTopologyOfTheSolid) {
  const Surface rod_surface(test::box({0, 0, 0}, {6, 2, 2}));
  MedialMesh balls = rod(Vector::Zero(), 1);
  balls.edges.clear();
  const ConnectedBalls chain = connect_balls(rod_surface, balls);
  EXPECT_EQ(chain.mesh.edges, rod(Vector::Zero(), 1).edges);
  EXPECT_EQ(chain.left_out, 0u);
  const Surface ring(test::torus(64, 24));
  MedialMesh circle;
  for (int i = 0; i < 24; ++i) {
    circle.centers.emplace_back(std::cos(i * 0.2617993877991494), std::sin(i * 0.2617993877991494), 0);
    circle.radii.push_back(0.34);
  }
  const ConnectedBalls around = connect_balls(ring, circle);
  EXPECT_EQ(around.mesh.edges.size(), 24u);
  EXPECT_EQ(topology(around.mesh).loops, 1);
  EXPECT_EQ(around.tetrahedra, 0u);
  circle.centers.emplace_back(0, 0, 0);  // in the hole
  circle.radii.push_back(0.1);
  EXPECT_EQ(connect_balls(ring, circle).left_out, 1u);
}

TEST(ConnectBalls, SaysWhereTwoBallsMeetInTwoPlaces) {
  const Surface ring(test::torus(64, 24));
  MedialMesh few;
  few.centers = {Point(1, 0, 0), Point(-1, 0, 0)};
  few.radii = {0.34, 0.34};
  const PlacedAxis two = place_axis(ring, {.mesh = few}, {.connect = true});
  EXPECT_EQ(two.mesh.edges.size(), 1u) << "one edge for both places, so that the loop is lost";
  EXPECT_NE(two.notes.back().find("1 component, 0 loops, 0 cavities, the solid has 1 component, 1 loop"),
            std::string::npos)
      << two.notes.back();
  few.centers.insert(few.centers.end(), {Point(0, 1, 0), Point(0, -1, 0)});
  few.radii.resize(4, 0.34);
  const PlacedAxis four = place_axis(ring, {.mesh = few}, {.connect = true});
  EXPECT_EQ(topology(four.mesh), solid_topology(ring));
  EXPECT_EQ(four.notes.size(), 1u) << "nothing to say of the topology";
}

TEST(ConnectBalls, OfAPlateAreOneSheetOrAtLeastAllOfIt) {
  const Surface plate(test::box({0, 0, 0}, {8, 8, 1}));
  MedialMesh balls;
  for (int i = 0; i < 40; ++i) {
    Random random(5, 0, static_cast<std::uint64_t>(i));
    balls.centers.emplace_back(0.5 + 7 * random.uniform(), 0.5 + 7 * random.uniform(), 0.5);
    balls.radii.push_back(0.5);
  }
  const Topology found = topology(connect_balls(plate, balls).mesh);
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(found.loops, 0);
  EXPECT_EQ(found.cavities, 0);
}

}  // namespace
}  // namespace orchard
