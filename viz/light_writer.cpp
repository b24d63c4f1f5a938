#include "orchard/viz/light_writer.h"

#include <vtkCellData.h>
#include <vtkPointData.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "vtk_data.h"

namespace orchard {

using namespace detail;

namespace {

constexpr double kSharpDegrees = 40;

// Segments, each with two points of its own.
struct OutlineSegments {
  std::vector<Point> points;
  std::vector<int> kinds;  // of each segment

  void add(const Point& a, const Point& b, int kind) {
    points.push_back(a);
    points.push_back(b);
    kinds.push_back(kind);
  }
};

void add_sharp_edges(const TriangleMesh& mesh, OutlineSegments& lines) {
  struct MeshSide {
    Index a, b, triangle;
  };
  std::vector<MeshSide> sides;
  for (Index t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      sides.push_back({a, b, t});
    }
  std::sort(sides.begin(), sides.end(), [](const MeshSide& x, const MeshSide& y) {
    return std::array{x.a, x.b, x.triangle} < std::array{y.a, y.b, y.triangle};
  });
  const auto normal = [&](Index t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return Vector((mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized());
  };
  const double limit = std::cos(kSharpDegrees * std::numbers::pi / 180);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].a == sides[i].a && sides[end].b == sides[i].b) ++end;
    if (end - i != 2 || normal(sides[i].triangle).dot(normal(sides[i + 1].triangle)) < limit)
      lines.add(mesh.vertices[sides[i].a], mesh.vertices[sides[i].b], 0);
    i = end;
  }
}

void add_section(const TriangleMesh& mesh, int axis, double place, OutlineSegments& lines) {
  for (const auto& triangle : mesh.triangles) {
    std::array<Point, 2> ends;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = mesh.vertices[triangle[k]], &b = mesh.vertices[triangle[(k + 1) % 3]];
      if ((a[axis] < place) == (b[axis] < place)) continue;
      ends.at(count++) = a + (place - a[axis]) / (b[axis] - a[axis]) * (b - a);
    }
    if (count == 2) lines.add(ends[0], ends[1], 1);
  }
}

}  // namespace

void write_outline(const std::filesystem::path& vtp, const Surface& surface, int sections) {
  OutlineSegments lines;
  add_sharp_edges(surface.mesh(), lines);
  const Box& box = surface.bounding_box();
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < sections; ++i)
      add_section(surface.mesh(), axis, box.min()[axis] + (i + 0.5) / sections * box.sizes()[axis], lines);
  vtkNew<vtkPolyData> data;
  set_points(data, lines.points.size(), [&](std::size_t i) { return lines.points[i]; });
  vtkNew<vtkCellArray> cells;
  for (Index i = 0; i < lines.kinds.size(); ++i) add_cell(cells, std::array{2 * i, 2 * i + 1});
  data->SetLines(cells);
  add_ints(data->GetCellData(), "kind", lines.kinds.size(), [&](std::size_t i) { return lines.kinds[i]; });
  write(vtp, data);
}

void write_balls(const std::filesystem::path& vtp, std::span<const Sphere> balls, std::span<const Index> vertices) {
  vtkNew<vtkPolyData> data;
  set_points(data, balls.size(), [&](std::size_t i) { return balls[i].center; });
  set_vertex_cells(data);
  add_doubles(data->GetPointData(), "radius", balls.size(), [&](std::size_t i) { return balls[i].radius; });
  add_ints(data->GetPointData(), "vertex", balls.size(), [&](std::size_t i) { return as_int(vertices[i]); });
  write(vtp, data);
}

}  // namespace orchard
