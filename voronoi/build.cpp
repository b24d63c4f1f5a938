#include "build.h"

#include <algorithm>
#include <string>

#include "coincident.h"
#include "insertion_order.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

Box box_of(std::span<const Point> points) {
  Box box;
  for (Index i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InputError("point " + std::to_string(i) + " has a coordinate that is not a finite number: remove it");
    box.extend(points[i]);
  }
  return box;
}

// Positions in `points` of four points far apart: each the farthest from what those before it span.
std::array<Index, 4> spanning_points(std::span<const Point> points) {
  const auto farthest = [&](auto&& distance) {
    Index best = 0;
    double best_distance = -1;
    for (Index i = 0; i < points.size(); ++i) {
      const double d = distance(points[i]);
      if (d > best_distance) best = i, best_distance = d;
    }
    return best;
  };
  const Index a = 0;
  const Point& origin = points[a];
  const Index b = farthest([&](const Point& p) { return (p - origin).squaredNorm(); });
  const Vector along = points[b] - origin;
  const Index c = farthest([&](const Point& p) { return (p - origin).cross(along).squaredNorm(); });
  const Vector normal = along.cross(points[c] - origin);
  const Index d = farthest([&](const Point& p) { return std::abs((p - origin).dot(normal)); });
  return {a, b, c, d};
}

// Moves the vertices over the free ones and turns squared radii into radii.
void finish(Workspace& workspace, std::span<const Index> original_of) {
  auto& vertices = workspace.vertices;
  std::vector<Index>& free = workspace.free_vertices;
  std::sort(free.begin(), free.end());
  Index end = static_cast<Index>(vertices.size());
  for (std::size_t f = 0; f < free.size() && free[f] < end; ++f) {
    while (end > free[f] && workspace.is_free(end - 1)) --end;
    if (free[f] >= end) break;
    const Index from = --end, to = free[f];
    vertices[to] = vertices[from];
    for (const Index neighbor : vertices[to].neighbors)
      for (Index& back : vertices[neighbor].neighbors)
        if (back == from) back = to;
  }
  free.clear();
  vertices.resize(end);
  for (VoronoiVertex& vertex : vertices) {
    vertex.radius =
        vertex.forming_points[3] == kInfinitePoint ? std::numeric_limits<double>::infinity() : std::sqrt(vertex.radius);
    if (original_of.empty()) continue;
    for (Index& point : vertex.forming_points)
      if (point != kInfinitePoint) point = original_of[point];
  }
}

// All points of the workspace in order. False if the inserter gives up.
bool insert_all(Workspace& workspace, Search search, std::string_view stage, const Progress& progress,
                InsertionCounts& counts) {
  workspace.clear();
  Inserter inserter(workspace, search);
  const std::array<Index, 4> first = spanning_points(workspace.points);
  if (!inserter.start(first))
    throw InputError("the points lie in a plane, so they have no Voronoi vertices: add a point off that plane");
  const std::size_t count = workspace.points.size(), step = std::max<std::size_t>(count / 64, 1);
  for (Index i = 0; i < count; ++i) {
    if (i % step == 0) report_progress(progress, stage, static_cast<double>(i) / static_cast<double>(count));
    if (std::find(first.begin(), first.end(), i) == first.end() && !inserter.insert(i)) return false;
  }
  report_progress(progress, stage, 1);
  counts = inserter.counts();
  return true;
}

}  // namespace

VoronoiDiagram build_voronoi(std::span<const Point> points, Search search, std::string_view stage,
                             const Progress& progress, BuildReport& report) {
  const Box box = box_of(points);
  const double radius = points.empty() ? 0 : box.diagonal().norm() / 2;
  if (radius > 0) report.duplicates = coincident_points(points, tolerance::kCoincidentPoints * radius);
  if (!(radius > 0) || points.size() - report.duplicates.size() < 4)
    throw InputError("a Voronoi diagram needs four points or more that do not coincide");

  // The points are worked on in the order of insertion, so that neighbours in space are neighbours in memory.
  std::vector<Index> original_of = insertion_order(points, box);
  if (!report.duplicates.empty()) {
    std::vector<bool> left_out(points.size(), false);
    for (const auto& pair : report.duplicates) left_out[pair[0]] = true;
    std::erase_if(original_of, [&](Index i) { return left_out[i]; });
  }
  Workspace workspace;
  workspace.set_scale(box);
  workspace.points.reserve(points.size());
  for (Index i : original_of) workspace.points.push_back(points[i]);
  // Surfaces have up to about eight vertices a point. Room that is not used is never touched, so it costs no memory.
  workspace.reserve(points.size() * 10 + 64);
  if (!insert_all(workspace, search, stage, progress, report.counts)) {
    workspace.set_exact(true);
    insert_all(workspace, search, stage, progress, report.counts);
  }
  report.exact = workspace.exact();

  finish(workspace, original_of);
  VoronoiDiagram diagram;
  diagram.points = std::move(workspace.points);
  diagram.points.assign(points.begin(), points.end());
  diagram.vertices = std::move(workspace.vertices);
  return diagram;
}

}  // namespace orchard::detail
