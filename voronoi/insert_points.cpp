#include <utility>

#include "build.h"
#include "coincident.h"
#include "insertion_order.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/highest_first.h"

namespace orchard {
namespace {

using detail::Workspace;

constexpr std::size_t kPerNewPoint = 10;  // vertices to have room for

std::vector<bool> forming(const VoronoiDiagram& diagram, std::size_t point_count) {
  std::vector<bool> present(point_count, false);
  for (const VoronoiVertex& vertex : diagram.vertices)
    for (const Index point : vertex.forming_points)
      if (point != kInfinitePoint) present[point] = true;
  return present;
}

// Inserts the points in the order; false if the signs contradict each other, or the diagram fails its final test.
bool insert_in_order(Workspace& workspace, std::span<const Index> order, InsertionReport& report) {
  detail::Inserter inserter(workspace, detail::Search::highest_first);
  std::size_t next = 0;
  const auto run = [&] {
    while (next < order.size() && inserter.insert(order[next])) ++next;
    return next == order.size() && inserter.insert_deferred();
  };
  if (!run()) {
    if (next == order.size()) return false;  // what is wrong is in the diagram already
    // With exact signs from here on. An exact diagram of the old points never needs the constrained search then.
    workspace.set_exact(true);
    report.exact_signs = true;
    run();
  }
  add_counts(inserter.counts(), report);
  return !report.exact_signs || inserter.counts().constrained == 0;
}

}  // namespace

void insert_points(VoronoiDiagram& diagram, std::span<const Point> added, InsertionReport* caller_report) {
  InsertionReport report;
  report.dimension = 3;
  const Box added_box = detail::checked_box(added);
  std::vector<Point> points = std::move(diagram.points);
  const auto first_new = static_cast<Index>(points.size());
  points.insert(points.end(), added.begin(), added.end());
  Box box = added_box;
  for (Index i = 0; i < first_new; ++i) box.extend(points[i]);

  bool good = !diagram.vertices.empty();
  if (good) {
    report.duplicates = detail::coincident_points(points, tolerance::kCoincidentPoints * box.diagonal().norm() / 2,
                                                  first_new, forming(diagram, points.size()));
    std::vector<Index> order = detail::insertion_order(added, added_box);
    for (Index& i : order) i += first_new;
    if (!report.duplicates.empty()) {
      std::vector<bool> left_out(points.size(), false);
      for (const auto& pair : report.duplicates) left_out[pair[0]] = true;
      std::erase_if(order, [&](Index i) { return left_out[i]; });
    }
    Workspace workspace;
    workspace.set_scale(box);
    workspace.points = std::move(points);
    workspace.adopt(std::move(diagram.vertices), kPerNewPoint * order.size());
    good = insert_in_order(workspace, order, report);
    detail::finish(workspace, {});
    diagram.vertices = std::move(workspace.vertices);
    points = std::move(workspace.points);
  }
  if (good)
    diagram.points = std::move(points);
  else
    diagram = highest_first_voronoi(points, {}, &report);
  if (caller_report != nullptr) *caller_report = std::move(report);
}

}  // namespace orchard
