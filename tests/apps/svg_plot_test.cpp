#include "svg_plot.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

namespace orchard::plot {
namespace {

Plot two_lines(const std::string& second) {
  Plot plot;
  plot.series = {{"tightened", {0, 1}, {1, 2}, Series::Kind::line}, {second, {0, 1}, {2, 1}, Series::Kind::line}};
  return plot;
}

std::size_t times(const std::string& what, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST(Plots, OfTheSameSeriesShareOneLegend) {
  const std::string svg = to_svg({two_lines("octree"), two_lines("octree"), two_lines("octree")}, 3);
  EXPECT_EQ(times(">tightened</text>", svg), 1U);
  EXPECT_EQ(times(">octree</text>", svg), 1U);
}

TEST(Plots, OfOtherSeriesHaveALegendEach) {
  const std::string svg = to_svg({two_lines("octree"), two_lines("merging")}, 2);
  EXPECT_EQ(times(">tightened</text>", svg), 2U);
  EXPECT_EQ(times(">octree</text>", svg), 1U);
  EXPECT_EQ(times(">merging</text>", svg), 1U);
}

TEST(Plots, WithNoNamesHaveNoLegend) {
  Plot plot = two_lines("");
  plot.series[0].name = "";
  const std::string bare = to_svg({plot, plot}, 2);
  EXPECT_NE(bare.find("height=\"300\""), std::string::npos);
}

TEST(Plots, OfNothingAreEmpty) { EXPECT_EQ(times("<g", to_svg({}, 3)), 0U); }

}  // namespace
}  // namespace orchard::plot
