#include "orchard/viz/skeleton_writer.h"

#include <vtkCellData.h>
#include <vtkPointData.h>

#include <algorithm>

#include "vtk_data.h"

namespace orchard {

using namespace detail;

namespace {

void add_skeleton_points(const CurveSkeleton& skeleton, vtkPolyData* data) {
  const std::size_t count = skeleton.vertices.size();
  set_points(data, count, [&](std::size_t i) { return skeleton.vertices[i]; });
  vtkPointData* arrays = data->GetPointData();
  add_doubles(arrays, "radius", count, [&](std::size_t i) { return skeleton.radii[i]; });
  add_doubles(arrays, "burn_time", count, [&](std::size_t i) { return finite_or_no_value(skeleton.burn_times[i]); });
  add_doubles(arrays, "erosion_thickness", count,
              [&](std::size_t i) { return finite_or_no_value(skeleton.burn_times[i] - skeleton.radii[i]); });
  add_ints(arrays, "node", count, [&](std::size_t i) {
    return std::binary_search(skeleton.nodes.begin(), skeleton.nodes.end(), static_cast<Index>(i)) ? 1 : 0;
  });
}

// In VTK's order of cells, `first` vertices come before the curves and the rest.
void add_skeleton_cells(const CurveSkeleton& skeleton, std::size_t first, vtkCellData* cells) {
  const std::size_t count = first + skeleton.arcs.size() + skeleton.sheets.size();
  const auto arc_at = [&](std::size_t i) -> const CurveSkeleton::Arc* {
    return i >= first && i < first + skeleton.arcs.size() ? &skeleton.arcs[i - first] : nullptr;
  };
  add_ints(cells, "curve", count,
           [&](std::size_t i) { return arc_at(i) != nullptr ? static_cast<int>(i - first) : -1; });
  const auto add = [&](const char* name, double CurveSkeleton::Arc::*member) {
    add_doubles(cells, name, count, [&](std::size_t i) {
      const CurveSkeleton::Arc* arc = arc_at(i);
      return arc != nullptr ? finite_or_no_value(arc->*member) : kNoValue;
    });
  };
  add("length", &CurveSkeleton::Arc::length);
  add("min_radius", &CurveSkeleton::Arc::min_radius);
  add("mean_radius", &CurveSkeleton::Arc::mean_radius);
  add("significance", &CurveSkeleton::Arc::significance);
  add_ints(cells, "curve_of_axis", count, [&](std::size_t i) {
    const CurveSkeleton::Arc* arc = arc_at(i);
    return arc != nullptr && arc->of_axis ? 1 : 0;
  });
}

}  // namespace

void write_curve_skeleton(const std::filesystem::path& vtp, const CurveSkeleton& skeleton) {
  vtkNew<vtkPolyData> data;
  add_skeleton_points(skeleton, data);
  std::vector<std::uint8_t> used(skeleton.vertices.size(), 0);
  for (const auto& edge : skeleton.edges) used[edge[0]] = used[edge[1]] = 1;
  for (const auto& triangle : skeleton.sheets) {
    for (const Index corner : triangle) used[corner] = 1;
  }
  vtkNew<vtkCellArray> points, lines, triangles;
  std::size_t single = 0;
  for (Index i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    add_cell(points, {&i, 1});
    ++single;
  }
  for (const CurveSkeleton::Arc& arc : skeleton.arcs) add_cell(lines, arc.vertices);
  for (const auto& triangle : skeleton.sheets) add_cell(triangles, triangle);
  data->SetVerts(points);
  data->SetLines(lines);
  data->SetPolys(triangles);
  add_skeleton_cells(skeleton, single, data->GetCellData());
  write(vtp, data);
}

}  // namespace orchard
