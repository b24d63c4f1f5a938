#include <utility>

#include "algorithms/build.h"
#include "certificate/certificate.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/highest_first.h"
#include "predicates/frame.h"
#include "workspace/coincident.h"
#include "workspace/insertion_order.h"

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

// The numbers of the added points (from first_new on), without duplicates, in an order in which neighbours in space
// follow each other.
std::vector<Index> order_of_new(std::span<const Point> added, Index first_new,
                                const std::vector<std::array<Index, 2>>& duplicates) {
  Box box;
  for (const Point& p : added) box.extend(p);
  std::vector<Index> order = detail::insertion_order(added, box);
  for (Index& i : order) i += first_new;
  std::vector<bool> left_out(first_new + added.size(), false);
  for (const auto& pair : duplicates) left_out[pair[0]] = true;
  std::erase_if(order, [&](Index i) { return left_out[i]; });
  return order;
}

struct Insertion {
  std::span<const VoronoiVertex> before;
  const detail::Frame& frame;
  std::span<const Index> order;
  Index first_new;
};

// Inserts the points into a copy of the diagram. Returns false if the result has no certificate. With exact signs, the
// diagram before must have a certificate as well: exact signs can contradict a diagram that rounding has changed,
// however little.
bool insert_into_copy(Workspace& workspace, const Insertion& insertion, bool exact, InsertionReport& report) {
  workspace.adopt(insertion.before, insertion.frame, kPerNewPoint * insertion.order.size());
  workspace.set_exact(exact);
  if (exact) workspace.forget_noise();
  const std::size_t before = detail::count_forming(workspace);
  if (exact && !detail::certify(workspace, before).holds) return false;
  detail::Inserter inserter(workspace, detail::Search::highest_first, insertion.order.size());
  for (const Index point : insertion.order)
    if (!inserter.insert(point)) return false;
  if (!inserter.insert_deferred()) return false;
  const std::size_t approximate = exact ? workspace.place_thin_vertices() : 0;
  detail::Repairer mender(workspace);
  const detail::Certificate certificate =
      detail::certify(workspace, before + insertion.order.size(), insertion.first_new, &mender);
  if (!certificate.holds) return false;
  add_counts(inserter.counts(), report);
  report.coplanar_centers += approximate;
  report.exact_signs = exact;
  report.certified_intrusion = certificate.intrusion;
  return true;
}

// Moves all of it: a copy could fail with the diagram already replaced.
InsertionReport replace(VoronoiDiagram& diagram, VoronoiBuild&& build) {
  diagram = std::move(build.diagram);
  return std::move(build.report);
}

}  // namespace

InsertionReport insert_points(VoronoiDiagram& diagram, std::span<const Point> added) {
  InsertionReport report;
  report.dimension = 3;
  const auto first_new = static_cast<Index>(diagram.points.size());
  std::vector<Point> points = diagram.points;
  points.insert(points.end(), added.begin(), added.end());
  const Box box = detail::checked_box(points);

  if (diagram.vertices.empty()) return replace(diagram, highest_first_voronoi(points));

  const detail::Frame frame(box);
  report.duplicates = detail::coincident_points(points, tolerance::kCoincidentPoints * box.diagonal().norm() / 2,
                                                first_new, forming(diagram, points.size()));
  const std::vector<Index> order = order_of_new(added, first_new, report.duplicates);
  const Insertion insertion{diagram.vertices, frame, order, first_new};
  Workspace workspace;
  set_scale(workspace, frame, box);
  workspace.points.reserve(points.size());
  for (const Point& p : points) workspace.points.push_back(frame.inward(p));
  if ((workspace.too_noisy() || !insert_into_copy(workspace, insertion, false, report)) &&
      !insert_into_copy(workspace, insertion, true, report)) {
    return replace(diagram, detail::build_voronoi(points, detail::Search::highest_first, "Voronoi diagram", {}, true));
  }
  detail::finish(workspace, frame, {});
  diagram.vertices = std::move(workspace.vertices);
  diagram.points = std::move(points);
  return report;
}

}  // namespace orchard
