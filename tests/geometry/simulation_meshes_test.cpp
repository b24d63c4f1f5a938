#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "expect_input_error.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"

// Files of VTK, Gmsh and Medit, most of them written by ParaView, meshio and Gmsh.
namespace orchard {
namespace {

namespace fs = std::filesystem;

struct Known {
  const char* file;
  double volume;
  Index vertices;  // after welding
};

// Cubes of side 1, with a pyramid of height 1 on one of them; "two" is two cubes side by side, as two volumes.
const Known kKnown[] = {{"vtp/ascii.vtp", 1, 8},
                        {"vtp/binary.vtp", 1, 8},
                        {"vtp/binary-zlib.vtp", 1, 8},
                        {"vtp/appended-raw.vtp", 1, 8},
                        {"vtp/appended-base64.vtp", 1, 8},
                        {"vtp/appended-zlib.vtp", 1, 8},
                        {"vtp/hexa-ascii.vtu", 1, 8},
                        {"vtp/tets-binary.vtu", 1, 8},
                        {"vtp/tets-zlib.vtu", 1, 8},
                        {"vtp/wedge-ascii.vtu", 1, 8},
                        {"vtp/pyramid-zlib.vtu", 4. / 3, 9},
                        {"vtp/quads-binary.vtu", 1, 8},
                        {"vtp/paraview-tets.vtu", 1, 8},
                        {"vtp/one-piece.vtp", 1. / 6, 4},
                        {"vtp/information-keys.vtp", 1. / 6, 4},
                        {"vtp/two-pieces.vtp", 1. / 3, 8},
                        {"vtk/box-ascii.vtk", 1, 8},
                        {"vtk/box-binary.vtk", 1, 8},
                        {"vtk/hexa-ascii.vtk", 1, 8},
                        {"vtk/tets-binary.vtk", 1, 8},
                        {"vtk/wedge-vtk42.vtk", 1, 8},
                        {"vtk/pyramid-vtk51.vtk", 4. / 3, 9},
                        {"vtk/quads-vtk51.vtk", 1, 8},
                        {"vtk/two-gmsh.vtk", 2, 12},
                        {"vtk/paraview-tets.vtk", 1, 8},
                        {"vtk/field-first.vtk", 1. / 6, 4},
                        {"msh/hexa-gmsh22-1.msh", 1, 8},
                        {"msh/hexa-gmsh-1.msh", 1, 8},
                        {"msh/wedge-gmsh22-0.msh", 1, 8},
                        {"msh/pyramid-gmsh22-1.msh", 4. / 3, 9},
                        {"msh/tets-gmsh-0.msh", 1, 8},
                        {"msh/quads-gmsh22-0.msh", 1, 8},
                        {"msh/two-msh22-1.msh", 2, 12},
                        {"msh/two-msh40-0.msh", 2, 12},
                        {"msh/two-msh41-1.msh", 2, 12},
                        {"msh/two-order2.msh", 2, 12},
                        {"mesh/hexa.mesh", 1, 8},
                        {"mesh/tets.mesh", 1, 8},
                        {"mesh/wedge.mesh", 1, 8},
                        {"mesh/pyramid.mesh", 4. / 3, 9},
                        {"mesh/quads.mesh", 1, 8},
                        {"mesh/two.mesh", 2, 12},
                        {"mesh/comments.mesh", 1. / 6, 4},
                        {"meshb/hexa.meshb", 1, 8},
                        {"meshb/tets.meshb", 1, 8},
                        {"meshb/wedge.meshb", 1, 8},
                        {"meshb/pyramid.meshb", 4. / 3, 9},
                        {"meshb/quads.meshb", 1, 8},
                        {"meshb/big-endian.meshb", 1. / 6, 4},
                        {"meshb/64-bit.meshb", 1. / 6, 4}};

fs::path corpus(const std::string& name) { return fs::path(ORCHARD_FUZZ_CORPUS) / name; }

TEST(SimulationMeshes, HaveTheirOuterSurfaceFacingOutward) {
  for (const Known& known : kKnown) {
    SCOPED_TRACE(known.file);
    MeshReading reading = read_mesh_and_report(corpus(known.file));
    EXPECT_TRUE(reading.report.complete());
    const double signed_volume = check_mesh(reading.mesh).volume;
    EXPECT_GT(signed_volume, 0);
    const MeshRepairReport repair = repair_mesh(reading.mesh);
    EXPECT_TRUE(repair.solid) << repair.faults;
    EXPECT_EQ(repair.flipped, 0u);
    EXPECT_NEAR(check_mesh(reading.mesh).volume, known.volume, 1e-6);
    // Gmsh divides some edges of the two cubes.
    EXPECT_GE(reading.mesh.vertices.size(), known.vertices);
    if (known.volume < 2) {
      EXPECT_EQ(reading.mesh.vertices.size(), known.vertices);
    }
  }
}

TEST(SimulationMeshes, TellWhatWasLeftOut) {
  const MeshReadReport two = read_mesh_and_report(corpus("msh/two-msh41-1.msh")).report;
  EXPECT_GT(two.volume_cells, 10u);
  EXPECT_GT(two.cells_beside, 10u);
  EXPECT_EQ(two.curved_cells, 0u);
  const MeshReadReport curved = read_mesh_and_report(corpus("msh/two-order2.msh")).report;
  EXPECT_EQ(curved.curved_cells, curved.volume_cells + curved.cells_beside);
  EXPECT_EQ(read_mesh_and_report(corpus("msh/surface.msh")).report.volume_cells, 0u);
  EXPECT_EQ(read_mesh_and_report(corpus("msh/quads-gmsh22-0.msh")).report.lines_skipped, 1u);
  EXPECT_EQ(curved.lines().size(), 3u);
}

TEST(SimulationMeshes, AreRefusedWithPlaceFaultAndRemedy) {
  const std::pair<const char*, const char*> cases[] = {
      {"vtk/huge-counts.vtk", "points are promised"},
      {"vtk/huge-polygons.vtk", "numbers are promised"},
      {"vtk/nan.vtk", "line 6"},
      {"vtk/structured.vtk", "save its surface"},
      {"msh/huge.msh", "line 5"},
      {"msh/missing-node.msh", "names node 7"},
      {"mesh/out-of-range.mesh", "line 8"},
      {"meshb/loop.meshb", "byte 8"},
      {"vtp/wild-offsets.vtp", "do not ascend"},
      {"vtp/wild-points.vtp", "names point 77"},
      {"vtp/fewer-points.vtp", "12 coordinates do not fit 99999999999 points"},
      {"vtp/nan-used.vtp", "finite"},
      {"vtp/appended-lz4.vtp", "save it with zlib"}};
  for (const auto& [name, words] : cases) {
    const fs::path file = corpus(name);
    test::expect_input_error([&] { read_mesh(file); }, {name, words});
  }
  test::expect_input_error([&] { read_mesh_and_report(corpus("vtp/image.vti"), "vtp"); },
                           {"PolyData and UnstructuredGrid"});
}

TEST(SimulationMeshes, AreReadByTheNameOfTheirFormat) {
  const fs::path copy = fs::path(testing::TempDir()) / "orchard-no-ending";
  fs::copy_file(corpus("mesh/two.mesh"), copy, fs::copy_options::overwrite_existing);
  EXPECT_EQ(read_mesh_and_report(copy, "mesh").mesh.triangles.size(),
            read_mesh(corpus("mesh/two.mesh")).triangles.size());
  test::expect_input_error([&] { read_mesh(copy); }, {"unknown mesh format"});
  fs::remove(copy);
}

// A tetrahedron with its corners in either order, so that its volume has either sign.
TEST(SimulationMeshes, TurnCellsThatAreInsideOut) {
  for (const char* corners : {"4 0 1 2 3", "4 0 2 1 3"}) {
    const fs::path file = fs::path(testing::TempDir()) / "orchard-turned.vtk";
    std::ofstream(file) << "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
                           "0 0 0 1 0 0 0 1 0 0 0 1 9 9 9\nCELLS 1 5\n"
                        << corners << "\nCELL_TYPES 1\n10\n";
    const TriangleMesh mesh = read_mesh(file);
    EXPECT_EQ(mesh.vertices.size(), 4u);
    EXPECT_NEAR(check_mesh(mesh).volume, 1. / 6, 1e-15);
    EXPECT_TRUE(check_mesh(mesh).solid());
    fs::remove(file);
  }
}

}  // namespace
}  // namespace orchard
