// Curve skeletons of the shared models and cases, as far as they are solids.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/medial/build.h"
#include "orchard/medial/curve_skeleton.h"
#include "support/effort.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTriangles = 8000, kMostTrianglesOfLongRuns = 60'000;

std::vector<fs::path> shared_files() {
  const fs::path models = ORCHARD_SHARED_MODELS;
  std::vector<fs::path> files;
  for (const fs::path& folder :
       {models / "clean", models / "peer", models / "robot", models / "dirty", models.parent_path() / "cases"}) {
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(SharedSkeletons, HaveTheTopologyOfTheirSolids) {
  const std::vector<fs::path> files = shared_files();
  if (files.empty()) GTEST_SKIP() << "no shared models";
  const std::size_t most = test::more() > 1 ? kMostTrianglesOfLongRuns : kMostTriangles;
  Index solids = 0, of_solids = 0, cut = 0;
  for (const fs::path& file : files) {
    TriangleMesh mesh;
    try {
      mesh = read_mesh(file);
    } catch (const InputError&) {
      continue;
    }
    if (mesh.triangles.size() > most || !repair_mesh(mesh).solid) continue;
    const Surface surface(std::move(mesh));
    // Where a mesh cuts itself, its inside hangs together otherwise than its surface does.
    const bool cuts_itself = !surface.self_intersections().empty();
    ++solids;
    MedialBuildOptions options{.check_promise = false};
    options.sampling.face_points = 800;
    options.sampling.edge_points = 200;
    const MedialMesh axis = medial_mesh(build_medial_axis(surface, options).axis);
    const CurveSkeleton skeleton = curve_skeleton(surface, axis);
    const Topology found = topology(medial_mesh(skeleton)), of_axis = topology(axis);
    EXPECT_EQ(found, of_axis) << file;
    if (of_axis.cavities == 0) {
      EXPECT_TRUE(skeleton.sheets.empty()) << file;
    }
    if (cuts_itself) {
      ++cut;
      continue;
    }
    EXPECT_EQ(found, solid_topology(surface)) << file;
    ++of_solids;
  }
  std::printf("%u solids were compared with their skeletons, and %u that cut themselves with their axes alone\n",
              of_solids, cut);
  EXPECT_EQ(solids, of_solids + cut);
  EXPECT_GT(of_solids, 5u);
}

}  // namespace
}  // namespace orchard
