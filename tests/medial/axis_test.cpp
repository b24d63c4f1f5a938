// More than 300 lines: one property of the axis a test, all on the same few solids and samplings.
#include "orchard/medial/axis.h"

#include <cmath>

#include "axis/interior.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/prune.h"
#include "orchard/voronoi/exact.h"
#include "support.h"
#include "support/shapes.h"

namespace orchard {
namespace {

SurfaceSampling points_at_vertices(const Surface& surface) {
  SurfaceSampling sampling;
  for (Index vertex = 0; vertex < surface.mesh().vertices.size(); ++vertex) {
    const Index triangle = surface.triangles_around(vertex)[0];
    const auto& corners = surface.mesh().triangles[triangle];
    sampling.points.push_back(surface.mesh().vertices[vertex]);
    sampling.triangles.push_back(triangle);
    sampling.features.push_back(corners[0] == vertex   ? Feature::vertex0
                                : corners[1] == vertex ? Feature::vertex1
                                                       : Feature::vertex2);
    sampling.origins.push_back(PointOrigin::edge);
  }
  return sampling;
}

MedialAxis axis_of(const Surface& surface, const SurfaceSampling& sampling) {
  MedialAxis axis = medial_axis(surface, sampling, exact_voronoi(sampling.points).diagram);
  validate(axis, surface);
  return axis;
}

// No point of the surface is farther than this from its nearest sample, as seen from 20 random points on each triangle,
// and half as much again.
double covering_radius(const Surface& surface, const SurfaceSampling& sampling) {
  double farthest = 0;
  for (Index triangle = 0; triangle < surface.mesh().triangles.size(); ++triangle) {
    Random random(7, 7, triangle);
    const auto [a, b, c] = surface.corners(triangle);
    for (int k = 0; k < 20; ++k) {
      const double u = std::sqrt(random.uniform()), v = random.uniform();
      const Point query = (1 - u) * a + u * (1 - v) * b + u * v * c;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Point& point : sampling.points) nearest = std::min(nearest, (point - query).norm());
      farthest = std::max(farthest, nearest);
    }
  }
  return 1.5 * farthest;
}

TEST(MedialAxis, OfABoxLiesBetweenTwoNearestSides) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 2000, .edge_points = 400});
  const MedialAxis axis = axis_of(surface, sampling);
  const double spacing = covering_radius(surface, sampling);
  for (Index i = 0; i < axis.size(); ++i) {
    const Point& c = axis.centers[i];
    std::array<double, 6> sides{c.x(), 1 - c.x(), c.y(), 2 - c.y(), c.z(), 3 - c.z()};
    std::sort(sides.begin(), sides.end());
    // A ball that touches points on two sides, and whose foot on the nearest side has a point within the spacing.
    EXPECT_LE(sides[1], std::hypot(sides[0], spacing)) << c.transpose();
    EXPECT_GE(axis.radii[i], sides[0] - 1e-12);
    EXPECT_LE(axis.radii[i], std::hypot(sides[0], spacing));
  }
  EXPECT_EQ(test::count_components(axis), 1u);
  EXPECT_EQ(test::farthest_outside(surface, axis), 0.0);
  EXPECT_GT(axis.faces.size(), 1000u);
}

TEST(MedialAxis, OfABoxReachesAllThirteenSheets) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const MedialAxis axis = axis_of(surface, sample_surface(surface, {.face_points = 2000, .edge_points = 400}));
  // One quadrilateral for each edge and the rectangle in the middle, which lies at half of the shortest side.
  std::array<int, 12> on_edge_sheet{};
  int in_the_middle = 0;
  for (const Point& c : axis.centers) {
    const std::array<double, 6> sides{c.x(), 1 - c.x(), c.y(), 2 - c.y(), c.z(), 3 - c.z()};
    if (std::abs(sides[0] - 0.5) < 0.02 && std::min({sides[2], sides[3], sides[4], sides[5]}) > 0.55) ++in_the_middle;
    int sheet = 0;
    for (unsigned a = 0; a < 4; ++a) {
      for (unsigned b = a % 2 == 0 ? a + 2 : a + 1; b < 6; ++b) {
        const double depth = std::max(sides[a], sides[b]);
        if (std::abs(sides[a] - sides[b]) < 0.05 && depth < 0.4) ++on_edge_sheet[static_cast<std::size_t>(sheet)];
        ++sheet;
      }
    }
    ASSERT_EQ(sheet, 12);
  }
  EXPECT_GT(in_the_middle, 50);
  for (const int count : on_edge_sheet) EXPECT_GT(count, 20);
}

TEST(MedialAxis, OfCosphericalPointsIsOneVertexThatAllOfThemForm) {
  for (const double radius : {1.0, 1e-3, 1e4}) {
    TriangleMesh mesh = test::icosphere(3, radius);
    const Index size = static_cast<Index>(mesh.vertices.size());
    const Surface surface(std::move(mesh));
    const MedialAxis axis = axis_of(surface, points_at_vertices(surface));
    ASSERT_EQ(axis.size(), 1u);
    EXPECT_LT(axis.centers[0].norm(), 1e-7 * radius);
    EXPECT_NEAR(axis.radii[0], radius, 1e-7 * radius);
    EXPECT_EQ(axis.forming_points[0].size(), size);
    EXPECT_TRUE(axis.neighbors[0].empty());
  }
}

TEST(MedialAxis, OfATorusFollowsTheCoreCircle) {
  const double minor = 0.35;
  const Surface surface(test::torus(64, 32, 1, minor));
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 1500, .edge_points = 0});
  const MedialAxis axis = axis_of(surface, sampling);
  const std::vector<double> angles = contact_angles(axis);
  int wide = 0;
  for (Index i = 0; i < axis.size(); ++i) {
    const Point& c = axis.centers[i];
    // The flat facets have spurs between them; what is seen between two sides of the solid is not theirs.
    if (angles[i] < 2) continue;
    ++wide;
    const double from_core = std::hypot(std::hypot(c.x(), c.y()) - 1, c.z());
    EXPECT_LT(from_core, 0.2 * minor) << c.transpose();
    EXPECT_NEAR(axis.radii[i], minor, 0.2 * minor);
  }
  EXPECT_GT(wide, 500);
  EXPECT_EQ(test::count_components(axis), 1u);
}

// Next to a crumpled surface there are vertices between points that its edges and creases turn every way. They see one
// side of the solid, and pass for no place between two.
TEST(MedialAxis, HasWideAnglesBetweenTwoSidesAlone) {
  int wide = 0, misled = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    TriangleMesh mesh = test::icosphere(3);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      Random random(seed, 7, i);
      mesh.vertices[i] *= 1 + random.uniform(-0.08, 0.08);
    }
    const Surface surface(std::move(mesh));
    const MedialAxis axis =
        axis_of(surface, sample_surface(surface, {.face_points = 600, .edge_points = 400, .crease_angle = 0.1}));
    MedialAxis by_points = axis;
    by_points.angles.clear();
    const std::vector<double> angles_by_points = contact_angles(by_points);
    for (Index i = 0; i < axis.size(); ++i) {
      const bool deep = -surface.signed_distance(axis.centers[i]) > 0.5;
      EXPECT_LE(axis.angles[i], angles_by_points[i]);
      EXPECT_TRUE(deep || axis.angles[i] <= 2);
      wide += axis.angles[i] > 2 ? 1 : 0;
      misled += angles_by_points[i] > 2 && !deep ? 1 : 0;
    }
  }
  EXPECT_GT(wide, 0);
  EXPECT_GT(misled, 0);
}

TEST(MedialAxis, OfPolyhedraTouchesTwoSidesAndAlmostNothingElse) {
  for (const TriangleMesh& mesh : {test::l_shape(), test::u_shape(0.5), test::two_boxes(0.5)}) {
    const Surface surface(mesh);
    const SurfaceSampling sampling = sample_surface(surface, {.face_points = 1500, .edge_points = 300});
    const MedialAxis axis = axis_of(surface, sampling);
    const double spacing = covering_radius(surface, sampling);
    for (Index i = 0; i < axis.size(); ++i) {
      const double depth = -surface.signed_distance(axis.centers[i]);
      EXPECT_LE(depth, axis.radii[i] * (1 + 1e-9));
      EXPECT_LE(axis.radii[i], std::hypot(depth, spacing));
    }
    EXPECT_EQ(test::count_components(axis), surface.report().components);
    EXPECT_EQ(test::farthest_outside(surface, axis), 0.0);
  }
}

TEST(MedialAxis, FormingPointsLieOnTheirBalls) {
  const Surface surface(test::l_shape());
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 800, .edge_points = 200});
  const MedialAxis axis = axis_of(surface, sampling);
  for (Index i = 0; i < axis.size(); ++i) {
    for (const Index point : axis.forming_points[i]) {
      EXPECT_NEAR((axis.points[point] - axis.centers[i]).norm(), axis.radii[i], 1e-6);
    }
  }
}

TEST(MedialAxis, NormalsPointOutward) {
  const Surface surface(test::l_shape());
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 300, .edge_points = 100});
  const MedialAxis axis = axis_of(surface, sampling);
  for (Index i = 0; i < sampling.size(); ++i) {
    EXPECT_NEAR(axis.normals[i].norm(), 1, 1e-12);
    EXPECT_GT(surface.signed_distance(axis.points[i] + 1e-6 * axis.normals[i]), 0);
    EXPECT_LT(surface.signed_distance(axis.points[i] - 1e-6 * axis.normals[i]), 0);
  }
}

TEST(MedialAxis, FacesJoinPointsThatFaceEachOther) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const MedialAxis axis = axis_of(surface, sample_surface(surface, {.face_points = 1000, .edge_points = 200}));
  for (Index face = 0; face < axis.faces.size(); ++face) {
    const auto [a, b] = axis.face_points[face];
    EXPECT_LT(axis.normals[a].dot(axis.normals[b]), 0.999);
    for (const Index corner : axis.faces[face]) {
      EXPECT_NEAR((axis.centers[corner] - axis.points[a]).norm(), (axis.centers[corner] - axis.points[b]).norm(), 1e-6);
    }
  }
}

TEST(MedialAxis, DoesNotDependOnTheOrderOfThePoints) {
  const Surface surface(test::icosphere(2));
  SurfaceSampling sampling;
  for (Index i = 0; i < 400; ++i) {  // unrelaxed: nothing is cospherical
    Random random(3, 3, i);
    const Point direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const ClosestPoint place = surface.closest(2 * direction.normalized());
    sampling.points.push_back(place.position);
    sampling.triangles.push_back(place.triangle);
    sampling.features.push_back(place.feature);
    sampling.origins.push_back(PointOrigin::face);
  }
  SurfaceSampling shuffled = sampling;
  Random random(4, 4);
  for (Index i = sampling.size(); i-- > 1;) {
    const Index k = static_cast<Index>(random.below(i + 1));
    std::swap(shuffled.points[i], shuffled.points[k]);
    std::swap(shuffled.triangles[i], shuffled.triangles[k]);
    std::swap(shuffled.features[i], shuffled.features[k]);
  }
  const MedialAxis a = axis_of(surface, sampling), b = axis_of(surface, shuffled);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.neighbors.items.size(), b.neighbors.items.size());
  EXPECT_EQ(a.faces.size(), b.faces.size());
  for (const Point& center : a.centers) {
    double nearest = 1;
    for (const Point& other : b.centers) nearest = std::min(nearest, (other - center).norm());
    EXPECT_LT(nearest, 1e-8);
  }
}

TEST(MedialAxis, ScalesWithTheSolidByPowersOfTwo) {
  const TriangleMesh mesh = test::l_shape();
  const Surface small(mesh), large(test::transformed(mesh, 16, Vector::Zero()));
  const SamplingOptions options{.face_points = 400, .edge_points = 100};
  const MedialAxis a = axis_of(small, sample_surface(small, options)),
                   b = axis_of(large, sample_surface(large, options));
  ASSERT_EQ(a.size(), b.size());
  for (Index i = 0; i < a.size(); ++i) {
    EXPECT_EQ(16 * a.centers[i], b.centers[i]);
    EXPECT_EQ(16 * a.radii[i], b.radii[i]);
  }
  EXPECT_EQ(a.neighbors.items, b.neighbors.items);
}

TEST(MedialAxis, ClassifiesVerticesAsTheSurfaceDoes) {
  for (const TriangleMesh& mesh : {test::u_shape(0.05), test::torus(32, 16), test::two_boxes(0.01)}) {
    const Surface surface(mesh);
    const VoronoiDiagram diagram =
        exact_voronoi(sample_surface(surface, {.face_points = 600, .edge_points = 100}).points).diagram;
    const std::vector<std::uint8_t> inside = detail::interior_vertices(surface, diagram);
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const VoronoiVertex& vertex = diagram.vertices[i];
      EXPECT_EQ(inside[i] != 0, !vertex.at_infinity() && surface.inside(vertex.center)) << i;
    }
  }
}

TEST(MedialAxis, LeavesOutVerticesWithoutAPosition) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 200, .edge_points = 50});
  VoronoiDiagram diagram = exact_voronoi(sampling.points).diagram;
  for (VoronoiVertex& vertex : diagram.vertices) {
    if (surface.bounding_box().contains(vertex.center)) {
      vertex.center = Point::Constant(std::numeric_limits<double>::quiet_NaN());
      break;
    }
  }
  validate(medial_axis(surface, sampling, diagram), surface);
}

TEST(MedialAxis, RefusesWhatIsNoSolid) {
  const Surface surface(test::open_box());
  EXPECT_THROW(medial_axis(surface, {}, {}), InputError);
}

TEST(MedialAxisValidation, NoticesDamage) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1}));
  const MedialAxis good = axis_of(surface, sample_surface(surface, {.face_points = 200, .edge_points = 50}));
  MedialAxis bad = good;
  bad.centers[3] = {5, 5, 5};
  EXPECT_THROW(validate(bad, surface), Error);
  bad = good;
  bad.neighbors.items[0] = 0;
  EXPECT_THROW(validate(bad, surface), Error);
  bad = good;
  bad.radii.pop_back();
  EXPECT_THROW(validate(bad, surface), Error);
  bad = good;
  bad.forming_points.items[2] = static_cast<Index>(bad.points.size());
  EXPECT_THROW(validate(bad, surface), Error);
}

TEST(ConnectedComponents, AreNumberedInTheOrderOfTheirFirstVertex) {
  MedialAxis axis;
  axis.centers.resize(5, Point::Zero());
  for (const std::vector<Index>& row : std::vector<std::vector<Index>>{{2}, {3}, {0}, {1}, {}}) {
    axis.neighbors.items.insert(axis.neighbors.items.end(), row.begin(), row.end());
    axis.neighbors.close_row();
  }
  Index count = 0;
  EXPECT_EQ(connected_components(axis, count), (std::vector<Index>{0, 1, 0, 1, 2}));
  EXPECT_EQ(count, 3u);
}

}  // namespace
}  // namespace orchard
