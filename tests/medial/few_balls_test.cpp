// What keeps medial meshes in few balls from running away: fins taken away that hold an edge, samples that guard the
// quadrics, and places looked for where the envelope is off the most.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "orchard/medial/simplify.h"
#include "orchard/medial/topology.h"
#include "simplify/climb.h"
#include "simplify/opened_link.h"
#include "simplify/slab_quadrics.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using detail::Assignment;
using detail::Ball4;
using detail::ContractibleMesh;
using detail::FitSample;

Surface bundled(const char* name) {
  return Surface(read_mesh(std::filesystem::path(ORCHARD_DATA_DIR) / (std::string(name) + ".obj")));
}

MedialMesh axis_of(const Surface& surface, Index points, const std::optional<RefineOptions>& refine) {
  return medial_mesh(
      build_medial_axis(surface,
                        {.sampling = {.face_points = points - points / 5, .edge_points = points / 5}, .refine = refine})
          .axis);
}

using Cells = std::set<std::array<Index, 3>>;
Cells cells_of(const ContractibleMesh& mesh) {
  Cells cells;
  for (auto cell : mesh.maximal_cells()) {
    if (cell[2] != cell[0]) std::sort(cell.begin(), cell.end());
    cells.insert(cell);
  }
  return cells;
}

// Two sheets along an edge ax, the second one with a fin that ends at w: a and b both reach w, by triangles with x.
TEST(OpenLink, TakesTheFinThatHoldsAnEdge) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0.5, 1}};
  mesh.radii.assign(4, 0.1);
  const Index a = 0, b = 1, w = 2, x = 3;
  mesh.triangles = {{a, b, x}, {a, w, x}, {b, w, x}};
  complete(mesh);
  ContractibleMesh contractible(mesh);
  ASSERT_FALSE(contractible.may_contract(a, b));
  const auto taken = detail::open_link(contractible, a, b);
  ASSERT_TRUE(taken.has_value());
  EXPECT_EQ(taken->size(), 1u);
  EXPECT_TRUE(contractible.may_contract(a, b));
  EXPECT_EQ(topology(contractible.mesh()), topology(mesh));
}

// A loop is no fin: nothing that may be taken away makes three edges around a hole contractible.
TEST(OpenLink, LeavesALoop) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.radii.assign(3, 0.1);
  mesh.edges = {{0, 1}, {0, 2}, {1, 2}};
  complete(mesh);
  ContractibleMesh contractible(mesh);
  EXPECT_FALSE(detail::open_link(contractible, 0, 1).has_value());
  EXPECT_EQ(contractible.mesh().edges.size(), 3u);
}

TEST(OpenLink, KeepsTheTopologyAndCanBeUndone) {
  int opened = 0;
  for (const TriangleMesh& solid : {test::torus(24, 12), test::l_shape()}) {
    const MedialMesh axis = axis_of(Surface(solid), 200, std::nullopt);
    const Topology expected = topology(axis);
    for (std::uint64_t k = 0; k < 4 * test::more(); ++k) {
      SCOPED_TRACE("seed " + std::to_string(k + test::first_seed()));
      Random random(k + test::first_seed(), 3);
      ContractibleMesh mesh(axis);
      for (int step = 0; step < 3000 && mesh.living() > 4; ++step) {
        const auto v = static_cast<Index>(random.below(mesh.size()));
        if (!mesh.alive(v) || mesh.neighbors(v).empty()) continue;
        const Index other = mesh.neighbors(v)[random.below(mesh.neighbors(v).size())];
        const bool free = mesh.may_contract(v, other);
        const Cells before = free ? Cells() : cells_of(mesh);
        const auto taken = detail::open_link(mesh, v, other);
        if (free) {
          ASSERT_TRUE(taken.has_value() && taken->empty());
        } else if (!taken) {
          ASSERT_EQ(cells_of(mesh), before);
          continue;
        } else {
          ++opened;
          ASSERT_FALSE(taken->empty());
          ASSERT_TRUE(mesh.may_contract(v, other));
          detail::undo(mesh, *taken);
          ASSERT_EQ(cells_of(mesh), before);
          for (const auto& [a, b, c] : *taken) ASSERT_EQ(mesh.collapse(a, b), c);
          ASSERT_EQ(topology(mesh.mesh()), expected);
        }
        mesh.contract(v, other, 0.5 * (mesh.ball(v) + mesh.ball(other)));
      }
      EXPECT_EQ(topology(mesh.mesh()), expected);
    }
  }
  EXPECT_GT(opened, 50);
}

// A mean over planes does not show that a sheet folds over beside a large one: without the guard the faucet's envelope
// leaves the surface by some 2 % of the diagonal, if not on every axis.
TEST(SlabQuadrics, TakeNoSampleFarWhileOthersAreLeft) {
  const Surface surface = bundled("faucet");
  const double diagonal = surface.bounding_box().diagonal().norm();
  const std::vector<FitSample> samples = detail::fit_samples(surface, 10'000, 1);
  double guarded = 0, unguarded = 0;
  for (const Index points : {500u, 550u}) {
    const MedialMesh axis = axis_of(surface, points, RefineOptions{});
    const auto max_after = [&](double min_limit) {
      ContractibleMesh mesh(axis);
      detail::contract_by_slabs(surface, mesh, samples, 500, 500, 1e-5 * diagonal, min_limit);
      EXPECT_EQ(mesh.living(), 500u);
      EXPECT_EQ(topology(mesh.mesh()), topology(axis));
      Assignment feet;  // of all cells, not of those nearby
      feet.find(mesh, samples);
      return feet.max / diagonal;
    };
    guarded = std::max(guarded, max_after(5e-4 * diagonal));
    unguarded = std::max(unguarded, max_after(std::numeric_limits<double>::infinity()));
  }
  EXPECT_LT(guarded, 0.01);
  EXPECT_LT(guarded, 0.5 * unguarded);
}

// A ball in a cube: the corners are farthest from it, and inside the faces' middles are in it deepest.
TEST(Climb, ComesToTheFarthestPlaceAround) {
  const Surface surface(test::box({0, 0, 0}, {2, 2, 2}));
  const Point middle = surface.bounding_box().center();
  MedialMesh single;
  single.centers = {middle};
  single.radii = {1};
  const ContractibleMesh mesh(single);
  std::vector<FitSample> samples;
  for (const double u : {-0.75, -0.25, 0.25, 0.75}) {
    for (const double v : {-0.75, -0.25, 0.25, 0.75})
      samples.push_back({middle + Vector(u, v, 1), Vector(0, 0, 1), 0.25});
  }
  const std::size_t before = samples.size();
  detail::climb(surface, mesh, 1, samples);
  EXPECT_LT(samples.size(), before);  // the same corners
  for (const FitSample& sample : samples) {
    EXPECT_NEAR(surface.distance(sample.position), 0, 1e-12);
    EXPECT_GT((sample.position - middle).norm() - 1, 0.65);  // sqrt(3) - 1 at a corner
    EXPECT_EQ(sample.weight, 0.25);
  }
}

// The ship's axis has a hundred fins to the shallow edges of its round parts. They held nearly all edges below 130
// balls, and what could still be contracted left the solid by 11 to 50 % of the diagonal.
TEST(FewBalls, DoNotRunAwayOnTheShip) {
  const Surface surface = bundled("ship");
  MedialBuildOptions options;
  options.refine.emplace();
  const MedialMesh axis = medial_mesh(build_medial_axis(surface, options).axis);
  // One ball that stands for too much makes the largest distance jump by a percent from count to count.
  const std::vector<Index> counts{120, 100, 80};
  const auto results = simplify_to_each(surface, axis, counts, {});
  ASSERT_EQ(results.size(), counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const SimplifiedMedialMesh& result = results[i];
    EXPECT_LE(result.mesh.size(), counts[i]);
    EXPECT_LT(result.report.hausdorff.max, 0.03);
    EXPECT_LT(result.report.hausdorff.mean, 0.003);
    EXPECT_EQ(topology(result.mesh), topology(axis));
  }
}

}  // namespace
}  // namespace orchard
