// Axes as arrays: tables, and NumPy's archive of the same numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "orchard/geometry/surface.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using test::Finished;
using test::Workplace;

// The text of a file in the folder of results; a missing one is a failure.
std::string text_of(const Workplace& here, const std::string& name) {
  const auto files = here.files("out");
  EXPECT_TRUE(files.contains(name)) << name;
  return files.contains(name) ? files.at(name) : std::string();
}

// The rows of a table without its head, which has to be `head`; comments are skipped.
std::vector<std::vector<double>> rows_of(const std::string& text, const std::string& head) {
  std::istringstream in(text);
  std::string line;
  EXPECT_TRUE(std::getline(in, line));
  EXPECT_EQ(line, head);
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    if (line.starts_with('#')) continue;
    std::vector<double>& row = rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) row.push_back(std::stod(word));
  }
  return rows;
}

// The numbers of an array of doubles in an archive, whose shape has to be `shape`.
std::vector<double> doubles_of(const std::string& archive, const std::string& name, const std::string& shape) {
  const std::size_t begin = archive.find("\x93NUMPY", archive.find(name + ".npy"));
  if (begin == std::string::npos) return {};
  const std::size_t size = static_cast<unsigned char>(archive[begin + 8]) +
                           std::size_t{256} * static_cast<unsigned char>(archive[begin + 9]);
  const std::string head = archive.substr(begin + 10, size);
  EXPECT_NE(head.find("'descr': '<f8', 'fortran_order': False, 'shape': " + shape), std::string::npos) << head;
  EXPECT_EQ((10 + size) % 64, 0u);
  const std::size_t end = archive.find("PK", begin + 10 + size);
  std::vector<double> numbers((end - begin - 10 - size) / sizeof(double));
  std::memcpy(numbers.data(), archive.data() + begin + 10 + size, numbers.size() * sizeof(double));
  return numbers;
}

TEST(AxisExport, TablesHaveTheBallsAndTheContactsThatTheyTouchTheSurfaceAt) {
  const Workplace here;
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(4, 3, 2));
  const std::string mesh = here.add("box.obj", box);
  const Finished run =
      here.run({"medial", mesh, "-o", (here / "out").string(), "--samples", "500", "--export", "csv,npz"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto balls = rows_of(text_of(here, "box-axis-balls.csv"), "x,y,z,radius,structure,structure_kind");
  const auto contacts = rows_of(text_of(here, "box-axis-contacts.csv"), "ball,x,y,z,sample");
  ASSERT_FALSE(balls.empty());
  ASSERT_FALSE(contacts.empty());
  const Surface surface(box);
  for (const auto& contact : contacts) {
    const auto& ball = balls.at(static_cast<std::size_t>(contact[0]));
    const Point place(contact[1], contact[2], contact[3]);
    EXPECT_LT(surface.distance(place), 1e-9);
    EXPECT_NEAR((place - Point(ball[0], ball[1], ball[2])).norm(), ball[3], 1e-6);
  }
  const auto samples = rows_of(text_of(here, "box-axis-samples.csv"), "x,y,z,ball");
  std::vector<double> largest(samples.size(), -1);  // ball that touches each sample
  for (const auto& contact : contacts) {
    const auto& sample = samples.at(static_cast<std::size_t>(contact[4]));
    EXPECT_EQ(Point(sample[0], sample[1], sample[2]), Point(contact[1], contact[2], contact[3]));
    double& ball = largest.at(static_cast<std::size_t>(contact[4]));
    ball = std::max(ball, balls.at(static_cast<std::size_t>(contact[0]))[3]);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (largest[i] < 0) {
      EXPECT_EQ(samples[i][3], 4294967295.0);
    } else {
      EXPECT_EQ(balls.at(static_cast<std::size_t>(samples[i][3]))[3], largest[i]);
    }
  }
  const auto triangles = rows_of(text_of(here, "box-axis-triangles.csv"), "a,b,c");
  for (const auto& triangle : triangles) {
    for (const double corner : triangle) EXPECT_LT(corner, static_cast<double>(balls.size()));
  }
  EXPECT_FALSE(rows_of(text_of(here, "box-axis-edges.csv"), "a,b").empty());
}

TEST(AxisExport, TheArchiveHasTheSameNumbersAsTheTables) {
  const Workplace here;
  const std::string mesh = here.add("box.obj", test::box(Point(0, 0, 0), Point(4, 3, 2)));
  const Finished run =
      here.run({"medial", mesh, "-o", (here / "out").string(), "--samples", "500", "--export", "npz,csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = rows_of(text_of(here, "box-axis-balls.csv"), "x,y,z,radius,structure,structure_kind");
  const std::string archive = text_of(here, "box-axis.npz");
  ASSERT_TRUE(archive.starts_with("PK\x03\x04"));
  const std::vector<double> balls = doubles_of(archive, "balls", "(" + std::to_string(rows.size()) + ", 4)");
  ASSERT_EQ(balls.size(), 4 * rows.size());
  for (std::size_t i = 0; i < balls.size(); ++i) EXPECT_EQ(balls[i], rows[i / 4][i % 4]);
}

TEST(AxisExport, IsRefusedInASweepWhichWritesNoAxis) {
  const Workplace here;
  const std::string mesh = here.add("box.obj", test::box(Point(0, 0, 0), Point(4, 3, 2)));
  const Finished run =
      here.run({"medial", mesh, "-o", (here / "out").string(), "--sweep", "samples=200,300", "--export", "npz"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--export has no effect with --sweep"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace orchard
