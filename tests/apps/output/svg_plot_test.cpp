#include "svg_plot.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
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

// Without it a page that is narrower cuts the picture off instead of scaling it.
TEST(Plots, HaveAViewBoxOfTheirSize) {
  for (const int columns : {1, 2, 3}) {
    const std::string svg = to_svg(std::vector<Plot>(5, two_lines("octree")), columns),
                      root = svg.substr(0, svg.find('>'));
    const auto value = [&](const std::string& name) {
      const std::size_t begin = root.find(' ' + name + "=\"") + name.size() + 3;
      return root.substr(begin, root.find('"', begin) - begin);
    };
    EXPECT_EQ(value("viewBox"), "0 0 " + value("width") + " " + value("height")) << root;
  }
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

// The attributes of what begins so, in the order of the drawing.
std::vector<std::string> drawn(const std::string& begin, const std::string& svg) {
  std::vector<std::string> all;
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1))
    all.push_back(svg.substr(at, svg.find('>', at) - at));
  return all;
}

TEST(Plots, LinesDifferByMoreThanTheirColor) {
  Plot plot;
  for (const char* name : {"a", "b", "c", "d", "e", "f"})
    plot.series.push_back({name, {0, 1}, {1, 2}, Series::Kind::line, plot.series.size() >= 3});
  const std::string svg = to_svg({plot});
  std::set<std::string> marks;
  for (const std::string& mark : drawn("<polygon", svg)) marks.insert(mark.substr(mark.find("points=")));
  EXPECT_EQ(marks.size(), 5U) << "and a circle";
  EXPECT_EQ(times("stroke-dasharray=\"6 4\"", svg), 6U) << "three lines and their samples in the legend";
  EXPECT_EQ(times("fill=\"white\" stroke=", svg), 9U) << "two points and a sample of each dashed line";
}

TEST(Plots, ALineKeepsItsLookWhereOthersAreLeftOut) {
  Plot all = two_lines("octree"), one = all;
  all.series[1].look = 1;
  one.series = {all.series[1]};
  const std::string svg = to_svg({one});
  EXPECT_EQ(drawn("<polygon", svg).size(), 3U) << "the second mark, a square";
  const std::string both = to_svg({all}), path = drawn("<path", svg).at(0), same = drawn("<path", both).at(1);
  EXPECT_EQ(path.substr(0, path.find(" d=")), same.substr(0, same.find(" d=")));
}

TEST(Plots, NoMarkLiesOnTheFrame) {
  Plot plot = two_lines("octree");
  plot.x_names = {"1", "2"};
  const std::string svg = to_svg({plot});
  const std::string frame = drawn("<rect x=", svg).front();
  const double left = std::stod(frame.substr(frame.find("x=\"") + 3));
  for (const std::string& mark : drawn("<circle", svg))
    EXPECT_GT(std::stod(mark.substr(mark.find("cx=\"") + 4)), left + 5);
}

TEST(Charts, AreDrawnFromWhatScriptsKeep) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "orchard-chart-test";
  std::filesystem::create_directories(folder);
  const auto made = [&](const std::string& charts) {
    std::ofstream(folder / "charts.json") << charts;
    std::filesystem::remove(folder / "picture.svg");
    std::string command = ORCHARD_CHART;
    for (const char* file : {"charts.json", "picture.svg"}) (command += ' ') += (folder / file).string();
    const int status = std::system((command += " 2> /dev/null").c_str());
    std::ifstream in(folder / "picture.svg");
    const std::string svg{std::istreambuf_iterator<char>(in), {}};
    return status == 0 ? svg : std::string();
  };
  const std::string svg = made(R"({"columns": 2, "plots": [
    {"title": "lamp & co", "y_label": "over R", "log_y": true, "x_names": ["one", "two"],
     "series": [{"name": "ours", "x": [0, 1], "y": [1, 0.1]}, {"name": "theirs", "dashed": true, "x": [0, 1], "y": [null, 1]}]},
    {"series": []}]})");
  for (const char* part : {"lamp &amp; co", ">over R<", ">ours<", ">theirs<", ">two<", "stroke-dasharray=\"6 4\""})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(made("{\"plots\": [{}]}"), "");
  EXPECT_EQ(made("nothing"), "");
  std::filesystem::remove_all(folder);
}

TEST(Plots, OfNothingAreEmpty) { EXPECT_EQ(times("<g", to_svg({}, 3)), 0U); }

}  // namespace
}  // namespace orchard::plot
