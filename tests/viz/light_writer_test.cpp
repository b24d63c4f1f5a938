#include "orchard/viz/light_writer.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <set>

#include "values.h"

namespace orchard {
namespace {

vtkSmartPointer<vtkPolyData> read_lines(const std::filesystem::path& file) {
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

TEST(WriteOutline, HasTheTwelveEdgesOfABoxAndItsSections) {
  const test::TestFolder folder;
  const Surface box(test::box({0, 0, 0}, {1, 2, 3}));
  write_outline(folder / "o.vtp", box, 2);
  const auto data = read_lines(folder / "o.vtp");
  vtkDataArray* kinds = data->GetCellData()->GetArray("kind");
  ASSERT_NE(kinds, nullptr);
  double edges = 0, sections = 0;
  for (vtkIdType i = 0; i < data->GetNumberOfLines(); ++i) {
    double a[3], b[3];
    data->GetPoint(2 * i, a);
    data->GetPoint(2 * i + 1, b);
    (kinds->GetComponent(i, 0) == 0 ? edges : sections) += (Point(a) - Point(b)).norm();
  }
  EXPECT_NEAR(edges, 4 * (1 + 2 + 3), 1e-9);
  EXPECT_NEAR(sections, 2 * 2 * ((2 + 3) + (1 + 3) + (1 + 2)), 1e-9) << "two rectangles across each axis";
}

TEST(WriteBalls, KeepsRadiiAndNumbers) {
  const test::TestFolder folder;
  const std::vector<Sphere> balls{{Point(1, 2, 3), 4}, {Point(5, 6, 7), 8}};
  const std::vector<Index> vertices{3, 9};
  write_balls(folder / "b.vtp", balls, vertices);
  const auto data = read_lines(folder / "b.vtp");
  ASSERT_EQ(data->GetNumberOfPoints(), 2);
  for (vtkIdType i = 0; i < 2; ++i) {
    double place[3];
    data->GetPoint(i, place);
    EXPECT_EQ(Point(place), balls[static_cast<std::size_t>(i)].center);
    EXPECT_EQ(data->GetPointData()->GetArray("radius")->GetComponent(i, 0), balls[static_cast<std::size_t>(i)].radius);
    EXPECT_EQ(data->GetPointData()->GetArray("vertex")->GetComponent(i, 0), vertices[static_cast<std::size_t>(i)]);
  }
}

}  // namespace
}  // namespace orchard
