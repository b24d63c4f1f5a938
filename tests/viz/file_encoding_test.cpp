#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "orchard/viz/voronoi_writer.h"
#include "orchard/voronoi/highest_first.h"
#include "values.h"
#include "vtk_data.h"

namespace orchard {
namespace {

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// XML parsers stop at bytes that are no text; see set_encoding() for who does.
void expect_text_within_elements(const std::string& file) {
  EXPECT_EQ(file.find("appended"), std::string::npos);
  EXPECT_EQ(file.find("AppendedData"), std::string::npos);
  EXPECT_NE(file.find("format=\"binary\""), std::string::npos);
  EXPECT_TRUE(std::all_of(file.begin(), file.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
}

TEST(ViewFiles, HoldTheirDataWhereEveryParaViewFindsIt) {
  const test::TestFolder folder;
  vtkNew<vtkPolyData> data;
  Random random(1, 1);
  detail::set_points(data, 5000,
                     [&](std::size_t) { return Point(random.uniform(), random.uniform(), random.uniform()); });
  detail::set_vertex_cells(data);
  detail::write(folder / "points.vtp", data);
  expect_text_within_elements(content(folder / "points.vtp"));

  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder / "points.vtp").c_str());
  reader->Update();
  ASSERT_EQ(reader->GetOutput()->GetNumberOfPoints(), 5000);
  for (vtkIdType i = 0; i < 5000; ++i) {
    for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(reader->GetOutput()->GetPoint(i)[axis], data->GetPoint(i)[axis]);
  }
}

TEST(ViewFiles, OfVoronoiCellsToo) {
  const test::TestFolder folder;
  std::vector<Point> points;
  points.reserve(60);
  Random random(2, 1);
  for (int i = 0; i < 60; ++i) points.emplace_back(random.uniform(), random.uniform(), random.uniform());
  write_voronoi_cells(folder / "cells.vtu", highest_first_voronoi(points).diagram);
  expect_text_within_elements(content(folder / "cells.vtu"));
}

}  // namespace
}  // namespace orchard
