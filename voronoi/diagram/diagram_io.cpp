#include "orchard/voronoi/diagram_io.h"

#include <limits>

#include "orchard/geometry/error.h"
#include "orchard/geometry/text_lines.h"

namespace orchard {
namespace {

Point read_point(TextLines& lines) {
  const double x = lines.real(), y = lines.real(), z = lines.real();
  return {x, y, z};
}

VoronoiVertex read_vertex(TextLines& lines, const std::vector<Point>& points, Index vertex_count) {
  VoronoiVertex vertex;
  vertex.center = read_point(lines);
  double sum = 0;
  for (Index& point : vertex.forming_points) {
    const std::int64_t number = lines.whole();
    if (number == -1) continue;
    if (number < 0 || number >= static_cast<std::int64_t>(points.size()))
      lines.fail("a forming point is beyond the last point (they count from 0; -1 is the one at infinity)");
    point = static_cast<Index>(number);
    sum += (points[point] - vertex.center).norm();
  }
  for (Index& neighbor : vertex.neighbors) {
    neighbor = lines.index();
    if (neighbor >= vertex_count) lines.fail("a neighbour is beyond the last vertex (they count from 0)");
  }
  vertex.radius = vertex.at_infinity() ? std::numeric_limits<double>::infinity() : sum / 4;
  return vertex;
}

}  // namespace

std::string to_vor(const VoronoiDiagram& diagram) {
  std::string text = "voronoi";
  append_number(text, static_cast<Index>(diagram.points.size()));
  append_number(text, static_cast<Index>(diagram.vertices.size()));
  const auto append_point = [&text](const Point& point) {
    for (int axis = 0; axis < 3; ++axis) append_number(text, point[axis]);
  };
  for (const Point& point : diagram.points) {
    text += "\np";
    append_point(point);
  }
  for (const VoronoiVertex& vertex : diagram.vertices) {
    text += "\nv";
    append_point(vertex.center);
    for (const Index point : vertex.forming_points) {
      if (point == kInfinitePoint)
        text += " -1";
      else
        append_number(text, point);
    }
    for (const Index neighbor : vertex.neighbors) append_number(text, neighbor);
  }
  return text + '\n';
}

VoronoiDiagram read_vor(const std::filesystem::path& file) {
  TextLines lines(file);
  lines.expect("voronoi");
  const Index points = lines.index(), vertices = lines.index();
  VoronoiDiagram diagram;  // it grows with the lines that are read, not with the count in the first line
  for (Index i = 0; i < points; ++i) {
    lines.expect("p");
    diagram.points.push_back(read_point(lines));
  }
  for (Index i = 0; i < vertices; ++i) {
    lines.expect("v");
    diagram.vertices.push_back(read_vertex(lines, diagram.points, vertices));
  }
  try {
    validate(diagram);
  } catch (const Error& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return diagram;
}

}  // namespace orchard
