// What a diagram must be is known even where points are nearly, but not quite, degenerate: no point deeper than
// tolerance::kVoronoiIntrusion in a sphere or beyond a facet of the hull. ORCHARD_SHAKEN_SETS=FIRST:COUNT in the
// environment lets the first test look at other and at more sets.
#include "voronoi/algorithms/shaken_sets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/highest_first.h"
#include "support/effort.h"
#include "voronoi/diagram/diagram_judge.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard {
namespace {

void expect_right(const std::string& name, const VoronoiDiagram& diagram) {
  ASSERT_NO_THROW(validate(diagram)) << name;
  const test::Judgement judgement = test::judge(diagram);
  EXPECT_LE(judgement.deepest, tolerance::kVoronoiIntrusion) << name << ": a point lies in a sphere";
  EXPECT_LE(judgement.beyond, tolerance::kVoronoiIntrusion) << name << ": a point lies beyond the hull";
  EXPECT_EQ(judgement.missing, 0u) << name;
}

void expect_right_at_once(const std::string& name, const test::Points& points) {
  const VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  if (!diagram.vertices.empty()) expect_right(name + ", at once", diagram);
}

// In steps of 1 to `most` points.
void expect_right_in_pieces(const std::string& name, const test::Points& points, std::uint64_t max,
                            std::uint64_t seed) {
  Random random(seed, 0x91eceu);
  VoronoiDiagram diagram;
  for (std::size_t at = 0; at < points.size();) {
    const std::size_t step = std::min<std::size_t>(points.size() - at, 1 + random.below(max));
    insert_points(diagram, std::span(points).subspan(at, step));
    at += step;
  }
  ASSERT_EQ(diagram.points, points) << name;
  if (!diagram.vertices.empty()) expect_right(name + ", in pieces", diagram);
}

std::uint64_t max_at_once(std::uint64_t seed) { return 1 + Random(seed, 0x57e9u).below(20); }

TEST(ShakenSets, HaveRightDiagramsAtOnceAndInPieces) {
  unsigned long long first = test::first_seed(), count = 120 * test::more();
  if (const char* asked = std::getenv("ORCHARD_SHAKEN_SETS")) {
    ASSERT_EQ(std::sscanf(asked, "%llu:%llu", &first, &count), 2) << "ORCHARD_SHAKEN_SETS=FIRST:COUNT";
  }
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const test::ShakenSet set = test::shaken_set(seed);
    expect_right_at_once(set.name, set.points);
    expect_right_in_pieces(set.name, set.points, max_at_once(seed), seed);
  }
}

// Found among thousands, each for a mistake of its own: a sphere, at once and in pieces, that was a neighbour's and not
// its own; a hull that was folded, turned around an edge twice, or had lost a point.
TEST(ShakenSets, ThatHadWrongDiagramsOnceHaveRightOnes) {
  for (const std::uint64_t seed : {640010906u, 30004220u, 17u, 83u, 127u, 238u, 320u, 340u, 360u, 362u, 5u, 15u, 26u,
                                   27u, 34u, 40u, 42u, 55u, 74u}) {
    const test::ShakenSet set = test::shaken_set(seed);
    expect_right_at_once(set.name, set.points);
    for (const std::uint64_t max : {1u, 4u, 20u}) expect_right_in_pieces(set.name, set.points, max, seed);
  }
}

TEST(ShakenSets, InPiecesOfWhichFlatVerticesMadeWrongDiagramsHaveRightOnes) {
  for (const std::uint64_t seed : {60020389u, 60021837u, 60024323u, 60033294u, 110903385u}) {
    const test::ShakenSet set = test::shaken_set(seed);
    expect_right_in_pieces(set.name, set.points, max_at_once(seed), seed);
  }
}

TEST(ShakenSets, InFilesThatHadWrongDiagramsOnceHaveRightOnes) {
  const std::filesystem::path folder = std::filesystem::path(ORCHARD_SHARED_MODELS).parent_path() / "points";
  for (const char* name : {"min_49", "min_54", "fail_54", "fail_12745", "pieces_69", "pieces_216"}) {
    const std::filesystem::path file = folder / (std::string(name) + ".xyz");
    if (!std::filesystem::exists(file)) continue;
    const test::Points points = read_points_or_mesh(file).vertices;
    expect_right_at_once(name, points);
    for (const std::uint64_t max : {1u, 3u, 7u, 20u})
      for (std::uint64_t seed = 0; seed < 5; ++seed) expect_right_in_pieces(name, points, max, seed);
  }
}

}  // namespace
}  // namespace orchard
