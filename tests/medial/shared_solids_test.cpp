#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <vector>

#include "hanging_pieces.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "support/brute_distance.h"
#include "support/effort.h"

// The refined axis of the shared models: in long runs of all that are solids as read or repaired, from other seeds.
namespace orchard {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = ORCHARD_SHARED_MODELS;
constexpr std::size_t kFewTriangles = 8000;     // up to which a model's contacts are judged by brute force
constexpr std::size_t kMaxTriangles = 100'000;  // larger ones take minutes at each number of points
constexpr double kPieceReach = 2;               // radii: pieces that hang by one vertex reach farther
constexpr Index kJudged = 2000;                 // balls of a model, evenly chosen

// Returns how many balls were looked at. Every radius is the distance to the surface, of exact and inexact balls alike.
Index judge_balls(const Surface& surface, const MedialAxis& axis) {
  const double tolerance = 1e-9 * surface.bounding_box().diagonal().norm();
  const Index step = std::max<Index>(1, axis.size() / kJudged);
  Index judged = 0;
  for (Index v = 0; v < axis.size(); v += step, ++judged) {
    EXPECT_NEAR(axis.radii[v], test::brute_distance(surface, axis.centers[v]), tolerance) << "vertex " << v;
  }
  return judged;
}

std::vector<fs::path> models() {
  std::vector<fs::path> files;
  for (const char* folder : {"clean", "peer", "robot", "dirty"})
    for (const auto& entry : fs::directory_iterator(kModels / folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

TEST(SharedSolids, KeepTheirTopologyWhenTheirAxisIsRefined) {
  if (!fs::exists(kModels)) GTEST_SKIP() << "no shared models";
  const bool all = test::more() > 1;
  Index built = 0, balls = 0;
  for (const fs::path& file : models()) {
    TriangleMesh mesh;
    try {
      mesh = read_mesh(file);
    } catch (const InputError&) {
      continue;  // a file of another kind, or one that holds more than triangles
    }
    if (mesh.triangles.size() > (all ? kMaxTriangles : 400)) continue;
    if (!repair_mesh(mesh).solid) continue;
    const Surface surface(std::move(mesh));
    // Where sheets cut each other, what is inside hangs together otherwise than the surface does.
    if (!surface.self_intersections().empty()) continue;
    for (const Index points : all ? std::vector<Index>{1000, 5000, 20'000} : std::vector<Index>{300}) {
      SCOPED_TRACE(file.filename().string() + ", " + std::to_string(points) + " points");
      MedialBuildOptions options;
      options.sampling.face_points = points - points / 5;
      options.sampling.edge_points = points / 5;
      options.sampling.seed = test::first_seed() + 1;
      options.refine.emplace();
      const MedialBuild build = build_medial_axis(surface, options);
      const MedialMesh mesh_of_axis = medial_mesh(build.axis);
      EXPECT_EQ(topology(mesh_of_axis), solid_topology(surface));
      EXPECT_EQ(test::hanging_pieces(mesh_of_axis, kPieceReach), 0u);
      if (surface.mesh().triangles.size() <= kFewTriangles) balls += judge_balls(surface, build.axis);
      ++built;
    }
  }
  EXPECT_GT(built, 0u);
  if (all) std::printf("%u axes, %u balls\n", built, balls);
}

}  // namespace
}  // namespace orchard
