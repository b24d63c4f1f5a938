#include "predicates/frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "voronoi/algorithms/shaken_sets.h"
#include "voronoi/diagram/diagram_judge.h"
#include "voronoi/point_sets.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard {
namespace {

using test::quadruples;

Box box_of(const test::Points& points) {
  Box box;
  for (const Point& p : points) box.extend(p);
  return box;
}

TEST(Frame, TakesLargeOffsetsOffWithoutRounding) {
  // Multiples of the spacing of doubles near the offset.
  const Vector offset(0x1p60, -0x1.8p60, 3);
  test::Points points, moved;
  for (const Point& p : test::grid_points(3)) points.push_back((p * 10).array().round() * 0x1p9);
  for (const Point& p : points) moved.push_back(p + offset);
  const detail::Frame frame(box_of(moved));
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points.size(); ++j)
      EXPECT_EQ(frame.outward((frame.inward(moved[i]) - frame.inward(moved[j])).norm()),
                (points[i] - points[j]).norm());
}

TEST(Frame, HasCoordinatesThatAreSmallAndMultiplesOfItsQuantum) {
  for (const double scale : {1e-99, 1e-10, 1.0, 1e10, 1e98}) {
    test::Points points = test::moved(test::uniform_points(50, 1), scale, Vector::Zero());
    points.push_back(scale * Point(1e-60, -1e-200, 0x1p-150));
    const detail::Frame frame(box_of(points));
    for (const Point& p : points)
      for (const double x : frame.inward(p)) {
        EXPECT_LT(std::abs(x), 4);
        EXPECT_EQ(std::ldexp(x, 200), std::nearbyint(std::ldexp(x, 200)));
      }
  }
}

TEST(Frame, LetsDiagramsBeTheSameAtEveryScaleThatIsAPowerOfTwo) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::Points points = test::shaken_set(seed).points;
    const VoronoiDiagram one = highest_first_voronoi(points).diagram;
    for (const int exponent : {-320, -280, -60, 60, 280, 320}) {
      const double scale = std::ldexp(1.0, exponent);
      const VoronoiDiagram other = highest_first_voronoi(test::moved(points, scale, Vector::Zero())).diagram;
      ASSERT_EQ(quadruples(one), quadruples(other)) << "seed " << seed << ", scale 2^" << exponent;
      for (std::size_t v = 0; v < one.vertices.size(); ++v)
        if (!one.vertices[v].at_infinity()) {
          ASSERT_EQ(std::ldexp(one.vertices[v].radius, exponent), other.vertices[v].radius);
        }
    }
  }
}

TEST(Frame, LetsPointsFarFromTheOriginHaveRightDiagrams) {
  for (const double offset : {1e3, 1e6, 1e8, 1e11, 1e15})
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const Vector far = offset * Vector(1, -0.7, seed % 2 == 0 ? 0 : 0.4);
      for (const test::Points& points :
           {test::bumpy_sphere_points(150, seed), test::grid_points(5), test::relaxed_polyhedron_points(150, seed)}) {
        test::Points moved = test::moved(points, 1, far);
        auto [diagram, report] = highest_first_voronoi(moved);
        if (offset < 1e14) {
          ASSERT_EQ(report.dimension, 3);
        }
        if (diagram.vertices.empty()) continue;
        ASSERT_NO_THROW(validate(diagram));
        test::Judgement judgement = test::judge(diagram);
        EXPECT_LE(judgement.deepest, tolerance::kVoronoiIntrusion) << offset;
        EXPECT_LE(judgement.beyond, tolerance::kVoronoiIntrusion) << offset;
        diagram = highest_first_voronoi(std::span(moved).first(100)).diagram;
        insert_points(diagram, std::span(moved).subspan(100));
        judgement = test::judge(diagram);
        EXPECT_LE(judgement.deepest, tolerance::kVoronoiIntrusion) << offset << ", inserted";
        EXPECT_LE(judgement.beyond, tolerance::kVoronoiIntrusion) << offset << ", inserted";
      }
    }
}

TEST(Frame, RefusesSizesBeyondItsLimitsAndTakesThoseUpToThem) {
  const test::Points points = test::uniform_points(60, 1);
  for (const double scale : {1e99, 1e-98}) {
    const test::Points scaled = test::moved(points, scale, Vector::Zero());
    EXPECT_EQ(quadruples(highest_first_voronoi(scaled).diagram), quadruples(exact_voronoi(scaled).diagram)) << scale;
  }
  for (const double scale : {1e101, 1e300, 1e-102, 1e-300}) {
    const test::Points scaled = test::moved(points, scale, Vector::Zero());
    EXPECT_THROW(highest_first_voronoi(scaled), InputError) << scale;
    VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
    if (scale > 1) {
      EXPECT_THROW(insert_points(diagram, scaled), InputError) << scale;
    }
  }
}

}  // namespace
}  // namespace orchard
