#include "orchard/viz/render.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <set>

#include "child_process.h"
#include "orchard/geometry/random.h"
#include "orchard/viz/view.h"
#include "orchard/voronoi/highest_first.h"
#include "values.h"

namespace orchard {
namespace {

using test::TestFolder;

// Sets or (null) unsets an environment variable for the time of a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Variable() { set(old_ ? old_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value == nullptr) {
      unsetenv(name_);
    } else {
      setenv(name_, value, 1);
    }
  }
  const char* name_;
  std::optional<std::string> old_;
};

// Every test runs without a display of its own and must leave neither processes nor temporary files.
class DrawPipeline : public testing::Test {
 protected:
  void TearDown() override {
    EXPECT_TRUE(waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD) << "a process is left";
    EXPECT_TRUE(std::filesystem::is_empty(temporary_.path())) << "temporary files are left";
  }
  PipelinePicture picture() const {
    PipelinePicture picture;
    picture.values = {&surface_, &sampling_, &axis_, &tree_};
    picture.renderer = ORCHARD_RENDERER;
    return picture;
  }
  std::filesystem::path script(const std::string& text) const {
    std::ofstream(folder_ / "script") << "#!/bin/sh\n" << text << "\n";
    std::filesystem::permissions(folder_ / "script", std::filesystem::perms::owner_all);
    return folder_ / "script";
  }
  bool no_xvfb() const { return detail::find_in_path("Xvfb").empty(); }

  const TestFolder folder_, temporary_;
  const Variable display_{"DISPLAY", nullptr}, temporary_folder_{"TMPDIR", temporary_.path().c_str()};
  const std::filesystem::path png_ = folder_ / "picture.png";
  const Surface surface_{test::l_shape()};
  const SurfaceSampling sampling_ = test::corner_sampling(surface_);
  const MedialAxis axis_ = test::small_axis();
  const SphereTree tree_ = test::random_tree(1, 3);
};

vtkSmartPointer<vtkImageData> read_png(const std::filesystem::path& file) {
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

// Colours in a part of the picture, given as fractions of its size from the lower left.
std::size_t distinct_colors(vtkImageData* image, double left, double right, double bottom, double top) {
  const int* size = image->GetDimensions();
  std::set<int> colors;
  for (int y = static_cast<int>(bottom * size[1]); y < static_cast<int>(top * size[1]); ++y) {
    for (int x = static_cast<int>(left * size[0]); x < static_cast<int>(right * size[0]); ++x) {
      const auto* pixel = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      colors.insert(pixel[0] << 16 | pixel[1] << 8 | pixel[2]);
    }
  }
  return colors.size();
}

TEST_F(DrawPipeline, FillsSixPanelsOfAPictureOfTheSizeAskedFor) {
  if (no_xvfb()) GTEST_SKIP() << "Xvfb is not in PATH";
  PipelinePicture request = picture();
  request.width = 660;
  request.height = 420;
  request.title = "L & <shape>";
  request.up = UpAxis::z;
  const PictureStatus status = draw_pipeline(png_, request);
  ASSERT_TRUE(status) << status.reason;
  const auto image = read_png(png_);
  EXPECT_EQ(image->GetDimensions()[0], 660);
  EXPECT_EQ(image->GetDimensions()[1], 420);
  const double top = 1 - 30.0 / 420;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 2; ++row) {
      EXPECT_GT(distinct_colors(image, column / 3.0, (column + 1) / 3.0, row * top / 2, (row + 1) * top / 2), 100u)
          << "row " << row << ", column " << column;
    }
  }
  EXPECT_GT(distinct_colors(image, 0, 1, top, 1), 5u) << "title";
}

TEST_F(DrawPipeline, MakesFewerPanelsOfFewerValuesAndChoosesTheWidth) {
  if (no_xvfb()) GTEST_SKIP() << "Xvfb is not in PATH";
  PipelinePicture request = picture();
  request.height = 200;
  request.values = {.surface = &surface_};
  ASSERT_TRUE(draw_pipeline(png_, request));
  const int one = read_png(png_)->GetDimensions()[0];
  request.values = {.surface = &surface_, .tree = &tree_};
  ASSERT_TRUE(draw_pipeline(png_, request));
  EXPECT_GT(read_png(png_)->GetDimensions()[0], 3 * one / 2);
  EXPECT_EQ(read_png(png_)->GetDimensions()[1], 200);
}

std::size_t colored_pixels(vtkImageData* image) {
  std::size_t count = 0;
  const int* size = image->GetDimensions();
  for (int y = 0; y < size[1]; ++y) {
    for (int x = 0; x < size[0]; ++x) {
      const auto* pixel = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      count += std::max({pixel[0], pixel[1], pixel[2]}) - std::min({pixel[0], pixel[1], pixel[2]}) > 30;
    }
  }
  return count;
}

TEST_F(DrawPipeline, ShowsVoronoiCellsCutOpenOrWhole) {
  if (no_xvfb()) GTEST_SKIP() << "Xvfb is not in PATH";
  std::vector<Point> points;
  points.reserve(300);
  Random random(1, 2, 3);
  for (int i = 0; i < 300; ++i) points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  Scene scene;
  scene.diagrams.push_back({"cells", highest_first_voronoi(points).diagram});
  PipelinePicture request = picture();
  request.height = 300;
  request.elevation = 0.9;
  ASSERT_TRUE(draw_view(png_, scene, request));
  const std::size_t cut = colored_pixels(read_png(png_));
  request.renderer = script(std::string("exec ") + ORCHARD_RENDERER + " \"$@\" --whole");
  ASSERT_TRUE(draw_view(png_, scene, request));
  EXPECT_GT(static_cast<double>(colored_pixels(read_png(png_))), 1.1 * static_cast<double>(cut));
}

TEST_F(DrawPipeline, GoesOnToXvfbWhereTheDisplayDoesNotServe) {
  if (no_xvfb()) GTEST_SKIP() << "Xvfb is not in PATH";
  const Variable dead("DISPLAY", ":64999");
  PipelinePicture request = picture();
  request.height = 100;
  request.values = {.surface = &surface_};
  const PictureStatus status = draw_pipeline(png_, request);
  EXPECT_TRUE(status) << status.reason;
}

TEST_F(DrawPipeline, SaysThatThereIsNeitherDisplayNorXvfb) {
  const Variable path("PATH", "");
  const PictureStatus status = draw_pipeline(png_, picture());
  EXPECT_FALSE(status);
  EXPECT_NE(status.reason.find("DISPLAY is not set"), std::string::npos) << status.reason;
  EXPECT_NE(status.reason.find("Xvfb (package xvfb) is not in PATH"), std::string::npos) << status.reason;
  EXPECT_FALSE(std::filesystem::exists(png_));
}

TEST_F(DrawPipeline, SurvivesTheAbortOfVtkWithoutADisplay) {
  const Variable path("PATH", ""), dead("DISPLAY", ":64999");
  const PictureStatus status = draw_pipeline(png_, picture());
  EXPECT_FALSE(status);
  EXPECT_NE(status.reason.find("was ended by signal"), std::string::npos) << status.reason;
}

TEST_F(DrawPipeline, SurvivesAServerWithoutOpenGl) {
  const std::filesystem::path xvfb = detail::find_in_path("Xvfb");
  if (xvfb.empty()) GTEST_SKIP() << "Xvfb is not in PATH";
  std::filesystem::rename(script("exec " + xvfb.string() + " \"$@\" -extension GLX"), folder_ / "Xvfb");
  const Variable path("PATH", folder_.path().c_str());
  const PictureStatus status = draw_pipeline(png_, picture());
  EXPECT_FALSE(status);
  EXPECT_NE(status.reason.find("orchard-render on display"), std::string::npos) << status.reason;
}

TEST_F(DrawPipeline, SaysThatThereIsNothingToDraw) {
  if (no_xvfb()) GTEST_SKIP() << "Xvfb is not in PATH";
  PipelinePicture request = picture();
  request.values = {};
  const PictureStatus status = draw_pipeline(png_, request);
  EXPECT_NE(status.reason.find("nothing to draw"), std::string::npos) << status.reason;
}

TEST_F(DrawPipeline, EndsARendererThatHangs) {
  const Variable display("DISPLAY", ":64999"), path("PATH", "");
  PipelinePicture request = picture();
  request.renderer = script("exec /bin/sleep 1000");
  request.timeout = std::chrono::seconds(0);
  const PictureStatus status = draw_pipeline(png_, request);
  EXPECT_FALSE(status);
  EXPECT_NE(status.reason.find("took longer than 0 s"), std::string::npos) << status.reason;
}

TEST_F(DrawPipeline, EndsTheRendererWhenItIsCancelled) {
  const Variable display("DISPLAY", ":64999"), path("PATH", "");
  PipelinePicture request = picture();
  request.renderer = script("exec /bin/sleep 1000");
  int asked = 0;
  request.progress = [&](std::string_view, double) { return ++asked < 20; };
  EXPECT_THROW(draw_pipeline(png_, request), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(png_));
}

TEST_F(DrawPipeline, EndsTheWaitForADisplayWhenItIsCancelled) {
  std::filesystem::rename(script("exec /bin/sleep 1000"), folder_ / "Xvfb");
  const Variable path("PATH", folder_.path().c_str());
  PipelinePicture request = picture();
  int asked = 0;
  request.progress = [&](std::string_view, double) { return ++asked < 20; };
  EXPECT_THROW(draw_pipeline(png_, request), Cancelled);
}

TEST_F(DrawPipeline, PassesOnTheLastWordsOfARendererThatFails) {
  const Variable display("DISPLAY", ":64999"), path("PATH", "");
  PipelinePicture request = picture();
  request.renderer = script("echo one; echo no colour left >&2; exit 1");
  EXPECT_NE(draw_pipeline(png_, request).reason.find("failed (no colour left)"), std::string::npos);
}

TEST_F(DrawPipeline, SaysThatTheRendererOrTheFolderIsMissing) {
  const Variable display("DISPLAY", ":64999"), path("PATH", "");
  PipelinePicture request = picture();
  request.renderer = folder_ / "nothing";
  EXPECT_NE(draw_pipeline(png_, request).reason.find("nothing"), std::string::npos);
  request.renderer = script("[ -f \"$1\" ] && echo picture > $2");
  EXPECT_TRUE(draw_pipeline(png_, request));
  EXPECT_FALSE(draw_pipeline(folder_ / "none/picture.png", request));
}

}  // namespace
}  // namespace orchard
