#include "orchard/geometry/sampling.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <map>
#include <string>

#include "orchard/geometry/tolerance.h"
#include "support/shapes.h"

namespace orchard {
namespace {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

std::vector<NamedMesh> meshes() {
  return {{"box", test::box({0, 0, 0}, {1, 2, 3})},
          {"flat box", test::box({0, 0, 0}, {1, 1, 1e-3})},
          {"l_shape", test::l_shape()},
          {"u_shape", test::u_shape(0.05)},
          {"two boxes", test::two_boxes(0.01)},
          {"open box", test::open_box()},
          {"torus", test::torus(24, 12)},
          {"icosphere", test::icosphere(3)},
          {"box scaled by 1e-6", test::transformed(test::box({0, 0, 0}, {1, 2, 3}), 1e-6, Vector::Zero())},
          {"l_shape offset by 1e6", test::transformed(test::l_shape(), 1, {1e6, 1e6, -1e6})},
          {"soup with needles",
           {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1e-9, 0}, {2, 2, 2}, {3, 0, 0}},
            {{0, 1, 2}, {0, 1, 3}, {4, 4, 4}, {1, 2, 0}, {1, 5, 0}, {1, 2, 4}}}}};
}

constexpr Relaxation kBoth[] = {Relaxation::clusters, Relaxation::neighbors};

bool same_bytes(const SurfaceSampling& a, const SurfaceSampling& b) {
  return a.points.size() == b.points.size() &&
         std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Point)) == 0 &&
         a.triangles == b.triangles && a.features == b.features && a.origins == b.origins;
}

TEST(Sampling, PutsEveryPointOnItsTriangleAndFeature) {
  for (const auto& [name, mesh] : meshes()) {
    const Surface surface(mesh);
    for (const Relaxation relaxation : kBoth) {
      const SurfaceSampling sampling =
          sample_surface(surface, {.face_points = 500, .edge_points = 200, .relaxation = relaxation});
      EXPECT_NO_THROW(validate(sampling, surface)) << name;
      EXPECT_GE(sampling.size(), 450u) << name;
      EXPECT_LE(sampling.size(), 700u) << name;
      for (Index i = 0; i < sampling.size(); ++i) {
        const auto [a, b, c] = surface.corners(sampling.triangles[i]);
        EXPECT_EQ(closest_point_of_triangle(sampling.points[i], a, b, c).feature, sampling.features[i]) << name;
        if (sampling.origins[i] == PointOrigin::edge) {
          EXPECT_NE(sampling.features[i], Feature::face) << name;
        }
      }
    }
  }
}

TEST(Sampling, KeepsPointsApart) {
  for (const auto& [name, mesh] : meshes()) {
    const Surface surface(mesh);
    const SurfaceSampling sampling = sample_surface(surface, {.face_points = 300, .edge_points = 300});
    for (Index i = 0; i < sampling.size(); ++i)
      for (Index j = 0; j < i; ++j)
        ASSERT_GT((sampling.points[i] - sampling.points[j]).norm(),
                  tolerance::kCoincidentPoints * surface.bounding_radius())
            << name;
  }
}

TEST(Sampling, DropsPointsThatCoincide) {
  // Every triangle twice: their edges get points at the same places.
  const TriangleMesh box = test::box({0, 0, 0}, {1, 1, 1});
  const SurfaceSampling sampling =
      sample_surface(Surface(test::joined({box, box})), {.face_points = 0, .edge_points = 240});
  EXPECT_EQ(sampling.size(), 120u);
}

TEST(Sampling, GivesTheSameBytesForAnyThreadCount) {
  for (const auto& [name, mesh] : meshes()) {
    const Surface surface(mesh);
    for (const Relaxation relaxation : kBoth) {
      const SamplingOptions options{.face_points = 600, .edge_points = 100, .iterations = 4, .relaxation = relaxation};
      std::vector<SurfaceSampling> results;
      for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(sample_surface(surface, options));
      }
      EXPECT_TRUE(same_bytes(results[0], results[1])) << name;
      EXPECT_TRUE(same_bytes(results[0], results[2])) << name;
      SamplingOptions other = options;
      other.seed = 2;
      EXPECT_FALSE(same_bytes(results[0], sample_surface(surface, other))) << name;
    }
  }
}

TEST(Sampling, ScalesExactlyByPowersOfTwo) {
  for (const auto& [name, mesh] : meshes()) {
    const double scale = std::ldexp(1.0, -20);
    const Surface surface(mesh), scaled(test::transformed(mesh, scale, Vector::Zero()));
    for (const Relaxation relaxation : kBoth) {
      const SamplingOptions options{.face_points = 200, .edge_points = 50, .iterations = 5, .relaxation = relaxation};
      SurfaceSampling other = sample_surface(scaled, options);
      for (Point& p : other.points) p /= scale;
      EXPECT_TRUE(same_bytes(sample_surface(surface, options), other)) << name;
    }
  }
}

TEST(Sampling, GivesEveryFaceItsShareOfTheArea) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 2200, .edge_points = 0});
  std::vector<double> counts(6, 0), areas(6, 0);
  for (Index t = 0; t < 12; ++t) areas[surface.clusters().of_triangle[t]] += surface.area(t);
  for (const Index t : sampling.triangles) ++counts[surface.clusters().of_triangle[t]];
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(counts[c], areas[c] * 100, 1);
}

TEST(Sampling, PlacesPointsUniformlyBeforeRelaxation) {
  // Chi-squared over the cells of a chart of one triangle.
  const Surface surface(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 20000, .edge_points = 0, .iterations = 0});
  std::map<std::pair<int, int>, double> counts;
  for (const Point& p : sampling.points) {
    // Cut into sixteen triangles of equal area by halving the unit square's folded parameters.
    const int i = static_cast<int>(4 * p.x()), j = static_cast<int>(4 * p.y());
    const bool upper = 4 * p.x() - i + 4 * p.y() - j > 1;
    ++counts[{i, 2 * j + upper}];
  }
  ASSERT_EQ(counts.size(), 16u);
  double chi_squared = 0;
  for (const auto& [cell, count] : counts) chi_squared += (count - 1250) * (count - 1250) / 1250;
  EXPECT_LT(chi_squared, 38);  // 15 degrees of freedom: exceeded once in a thousand
}

TEST(Sampling, SpacesEdgePointsEvenlyAndOffTheCorners) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 0, .edge_points = 240});
  ASSERT_EQ(sampling.size(), 240u);
  // Ten points per unit of length, half a gap at each end.
  for (Index i = 0; i < sampling.size(); ++i) {
    EXPECT_EQ(sampling.origins[i], PointOrigin::edge);
    int on_sides = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = sampling.points[i][axis];
      if (x == 0 || x == axis + 1)
        ++on_sides;
      else
        EXPECT_NEAR(10 * x - std::floor(10 * x), 0.5, 1e-9);
    }
    EXPECT_EQ(on_sides, 2);
  }
}

struct EvennessBounds {
  double variation_before, variation_after, min_after;
};

// Whatever is in the way of comparing with the best possible is far below what these bounds tell apart: a random spread
// has a variation of 0.52, and a good one of 0.05 to 0.1.
void expect_evened_out(const TriangleMesh& mesh, SamplingOptions options, const EvennessBounds& bounds) {
  const Surface surface(mesh);
  const Evenness after = evenness(sample_surface(surface, options), surface);
  options.iterations = 0;
  const Evenness before = evenness(sample_surface(surface, options), surface);
  EXPECT_GT(before.variation, bounds.variation_before);
  EXPECT_LT(after.variation, bounds.variation_after);
  EXPECT_GT(after.mean, 1.5 * before.mean);
  EXPECT_GT(after.min, bounds.min_after);
}

TEST(Sampling, RelaxationInsideClustersEvensOutFlatFaces) {
  for (const TriangleMesh& mesh :
       {test::box({0, 0, 0}, {1, 2, 3}), test::l_shape(), test::u_shape(0.2), test::open_box()})
    expect_evened_out(mesh, {.face_points = 1500, .edge_points = 0, .relaxation = Relaxation::clusters},
                      {.variation_before = 0.45, .variation_after = 0.15, .min_after = 0.2});
}

TEST(Sampling, RelaxationByNeighborsEvensOutAnySurface) {
  for (const TriangleMesh& mesh : {test::box({0, 0, 0}, {1, 2, 3}), test::l_shape(), test::open_box(),
                                   test::torus(24, 12), test::torus(200, 100), test::icosphere(1), test::icosphere(5)})
    expect_evened_out(mesh, {.face_points = 1000, .edge_points = 0, .relaxation = Relaxation::neighbors},
                      {.variation_before = 0.3, .variation_after = 0.12, .min_after = 0.3});
}

TEST(Sampling, RelaxationByNeighborsKeepsTheDensityTheSameEverywhere) {
  // A sphere in halves, quarters and eighths: as many points on each side of each coordinate plane.
  const Surface surface(test::icosphere(4));
  const SurfaceSampling sampling =
      sample_surface(surface, {.face_points = 4000, .edge_points = 0, .relaxation = Relaxation::neighbors});
  std::array<int, 8> counts{};
  for (const Point& p : sampling.points)
    ++counts[static_cast<std::size_t>((p.x() > 0) + 2 * (p.y() > 0) + 4 * (p.z() > 0))];
  for (const int count : counts) EXPECT_NEAR(count, 500, 25);
}

TEST(Sampling, FacePointsKeepAwayFromEdgePoints) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  for (const Relaxation relaxation : kBoth) {
    const SurfaceSampling sampling =
        sample_surface(surface, {.face_points = 1000, .edge_points = 160, .relaxation = relaxation});
    EXPECT_GT(std::ranges::count(sampling.origins, PointOrigin::edge), 100);
    EXPECT_LT(evenness(sampling, surface).variation, 0.15);
    EXPECT_GT(evenness(sampling, surface).min, 0.25);
  }
}

TEST(Sampling, PutsEdgePointsOnCreasesOnlyWhereThereAreNoClusters) {
  const Surface sphere(test::icosphere(3));
  const SurfaceSampling smooth =
      sample_surface(sphere, {.face_points = 300, .edge_points = 100, .relaxation = Relaxation::neighbors});
  EXPECT_EQ(smooth.size(), 400u);
  EXPECT_EQ(std::ranges::count(smooth.origins, PointOrigin::edge), 0);
  const SurfaceSampling creased = sample_surface(
      sphere, {.face_points = 300, .edge_points = 100, .relaxation = Relaxation::neighbors, .crease_angle = 0.01});
  EXPECT_GT(std::ranges::count(creased.origins, PointOrigin::edge), 0);
}

TEST(Sampling, ChoosesTheRelaxationByThePointsPerCluster) {
  const Surface box(test::box({0, 0, 0}, {1, 2, 3})), sphere(test::icosphere(3));
  EXPECT_EQ(choose_relaxation(box, {}), Relaxation::clusters);
  EXPECT_EQ(choose_relaxation(box, {.face_points = 30}), Relaxation::neighbors);
  EXPECT_EQ(choose_relaxation(sphere, {}), Relaxation::neighbors);
  EXPECT_EQ(choose_relaxation(sphere, {.face_points = 0}), Relaxation::clusters);
  EXPECT_EQ(choose_relaxation(sphere, {.cluster_angle = 1}), Relaxation::clusters);
  EXPECT_EQ(choose_relaxation(box, {.relaxation = Relaxation::neighbors}), Relaxation::neighbors);
  EXPECT_EQ(choose_relaxation(sphere, {.relaxation = Relaxation::clusters}), Relaxation::clusters);
}

TEST(Sampling, RelaxesInsideCurvedClusters) {
  const Surface surface(test::icosphere(4));
  SamplingOptions options{.face_points = 2000, .edge_points = 0, .cluster_angle = 0.3};
  const SurfaceSampling sampling = sample_surface(surface, options);
  EXPECT_NO_THROW(validate(sampling, surface));
  options.iterations = 0;
  EXPECT_LT(evenness(sampling, surface).variation, 0.6 * evenness(sample_surface(surface, options), surface).variation);
}

TEST(Sampling, RefusesFewerThanFourPoints) {
  const Surface surface(test::l_shape());
  EXPECT_THROW((void)sample_surface(surface, {.face_points = 2, .edge_points = 1}), InputError);
  EXPECT_NO_THROW((void)sample_surface(surface, {.face_points = 3, .edge_points = 1}));
}

TEST(Sampling, GetsAlongWithoutArea) {
  const Surface needle(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, {{0, 1, 2}}});
  const Surface dot(TriangleMesh{{{1, 2, 3}}, {{0, 0, 0}}});
  for (const Relaxation relaxation : kBoth) {
    const SamplingOptions options{.face_points = 20, .edge_points = 20, .relaxation = relaxation};
    EXPECT_NO_THROW(validate(sample_surface(needle, options), needle));
    EXPECT_EQ(sample_surface(dot, options).size(), 0u);
    EXPECT_EQ(evenness(sample_surface(dot, options), dot).mean, 0);
  }
}

TEST(Sampling, StopsWhenToldTo) {
  const Surface surface(test::l_shape());
  EXPECT_THROW((void)sample_surface(surface, {}, [](std::string_view, double) { return false; }), Cancelled);
}

TEST(Sampling, ValidationFindsWhatIsWrong) {
  const Surface surface(test::l_shape());
  const SurfaceSampling good = sample_surface(surface, {.face_points = 100, .edge_points = 10});
  SurfaceSampling bad = good;
  bad.features.pop_back();
  EXPECT_THROW(validate(bad, surface), Error);
  bad = good;
  bad.points[7] += 1e-9 * surface.normal(bad.triangles[7]);
  EXPECT_THROW(validate(bad, surface), Error);
  bad = good;
  bad.triangles[3] = kNone;
  EXPECT_THROW(validate(bad, surface), Error);
}

}  // namespace
}  // namespace orchard
