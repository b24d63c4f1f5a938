#include "orchard/voronoi/diagram_io.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "orchard/geometry/error.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "voronoi/point_sets.h"

namespace orchard {
namespace {

class VorFile : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() /
            ("orchard-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" +
             std::to_string(::getpid()) + ".vor");  // other processes may run the same test
  }
  void TearDown() override { std::filesystem::remove(file_); }
  VoronoiDiagram read(const std::string& text) {
    std::ofstream(file_, std::ios::binary) << text;
    return read_vor(file_);
  }
  std::string fault(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

 private:
  std::filesystem::path file_;
};

TEST_F(VorFile, ReadsBackWhatWasWritten) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    if (points.size() > 3000) continue;
    for (const VoronoiDiagram& diagram : {highest_first_voronoi(points).diagram, exact_voronoi(points).diagram}) {
      const VoronoiDiagram again = read(to_vor(diagram));
      ASSERT_EQ(again.points, diagram.points) << name;
      ASSERT_EQ(again.vertices.size(), diagram.vertices.size()) << name;
      for (std::size_t v = 0; v < diagram.vertices.size(); ++v) {
        const VoronoiVertex &a = diagram.vertices[v], &b = again.vertices[v];
        ASSERT_EQ(a.center, b.center) << name;
        ASSERT_EQ(a.forming_points, b.forming_points) << name;
        ASSERT_EQ(a.neighbors, b.neighbors) << name;
        ASSERT_EQ(a.at_infinity(), !std::isfinite(b.radius)) << name;
      }
      ASSERT_EQ(to_vor(again), to_vor(diagram)) << name;
    }
  }
}

TEST_F(VorFile, GivesRadiiFromTheFormingPoints) {
  const VoronoiDiagram diagram = exact_voronoi(test::uniform_points(300, 4)).diagram;
  const VoronoiDiagram again = read(to_vor(diagram));
  for (std::size_t v = 0; v < diagram.vertices.size(); ++v) {
    if (diagram.vertices[v].at_infinity()) continue;
    EXPECT_NEAR(again.vertices[v].radius, diagram.vertices[v].radius, 1e-9 * diagram.vertices[v].radius);
  }
}

TEST_F(VorFile, ThatIsDamagedIsRefusedWithTheFaultAndItsLine) {
  const std::string good = to_vor(exact_voronoi(test::uniform_points(8, 1)).diagram);
  EXPECT_EQ(fault(good), "none");
  EXPECT_NE(fault("").find("starts with \"voronoi\""), std::string::npos);
  EXPECT_NE(fault("points 3\n").find("line 1: expected"), std::string::npos);
  EXPECT_NE(fault("voronoi 4000000000 4000000000\np 0 0 0\n").find("cut off"), std::string::npos);
  EXPECT_NE(fault("voronoi 1 0\np 0 nan 0\n").find("line 2: the number is not finite"), std::string::npos);
  EXPECT_NE(fault("voronoi 1 1\np 0 0 0\nv 0 0 0 0 1 2 3 0 0 0 0\n").find("beyond the last point"), std::string::npos);
  EXPECT_NE(fault("voronoi 1 1\np 0 0 0\nv 0 0 0 0 -2 0 0 0 0 0 0\n").find("beyond the last point"), std::string::npos);
  EXPECT_NE(fault("voronoi 1 1\np 0 0 0\nv 0 0 0 0 0 0 0 0 0 0 9\n").find("beyond the last vertex"), std::string::npos);
  EXPECT_NE(fault("voronoi 1 1\np 0 0 0\nv 0 0 0 0 0 0 0 0 0 0 0\n").find("twice"), std::string::npos);
  EXPECT_THROW(read_vor("no/such/file.vor"), InputError);
  EXPECT_THROW(read_vor(std::filesystem::temp_directory_path()), InputError);
}

// Any change of one digit is either refused or gives a consistent diagram.
TEST_F(VorFile, NeverGivesAnInconsistentDiagramForAChangedDigit) {
  const std::string good = to_vor(exact_voronoi(test::uniform_points(9, 2)).diagram);
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 8; at < good.size(); at += 3) {
    if (good[at] < '0' || good[at] > '9') continue;
    std::string text = good;
    text[at] = static_cast<char>('0' + (good[at] - '0' + 1) % 10);
    ++tried;
    try {
      const VoronoiDiagram diagram = read(text);
      EXPECT_NO_THROW(validate(diagram));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, tried / 10);
  EXPECT_LT(refused, tried);
}

}  // namespace
}  // namespace orchard
