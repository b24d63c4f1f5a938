#include "hull_edges.h"

#include <array>

namespace orchard::detail {
namespace {

// The way around each edge is a chain of vertices, each of which is known only once the last one has come from memory:
// so many are walked at the same time.
constexpr std::size_t kWalks = 12;

// The plane of three points, for many points that are held against it.
class FacetPlane {
 public:
  FacetPlane() = default;
  FacetPlane(const Point& a, const Point& b, const Point& c) : origin_(a), normal_((b - a).cross(c - a)) {
    const Vector ab = (b - a).cwiseAbs(), ac = (c - a).cwiseAbs();
    magnitude_ =
        Vector(ab.y() * ac.z() + ab.z() * ac.y(), ab.z() * ac.x() + ab.x() * ac.z(), ab.x() * ac.y() + ab.y() * ac.x());
  }
  // Whether volume_sign(p, a, b, c) is positive, as far as doubles tell: the same 8 roundings as in volume(), and one
  // for what is of second order.
  bool is_certainly_above(const Point& p) const {
    const Vector to_origin = origin_ - p;
    return to_origin.dot(normal_) > 9 * kRounding * to_origin.cwiseAbs().dot(magnitude_);
  }

 private:
  Point origin_;
  Vector normal_, magnitude_;  // and what its roundings are relative to
};

FacetPlane plane_of(const Workspace& workspace, Index v) {
  const auto& corner = workspace.vertices[v].forming_points;
  return {workspace.points[corner[0]], workspace.points[corner[1]], workspace.points[corner[2]]};
}

struct Walk {
  FacetPlane plane;
  HullPlace place;
  HullEdge* edge;
};

}  // namespace

void note_convex(const Workspace& workspace, std::span<HullEdge> edges) {
  for (const HullEdge& edge : edges) __builtin_prefetch(&workspace.vertices[edge.u]);
  for (HullEdge& edge : edges) {
    const VoronoiVertex& next = workspace.vertices[edge.u];
    const Index across = next.forming_points[index_of(next.neighbors, edge.v)];
    edge.convex = plane_of(workspace, edge.v).is_certainly_above(workspace.points[across]);
  }
}

void walk_to_doubt(const Workspace& workspace, std::span<HullEdge> edges) {
  const auto begin = [&workspace](HullEdge& edge) {
    return Walk{plane_of(workspace, edge.v), HullPlace::first(workspace.vertices[edge.v], edge.v, edge.slot), &edge};
  };
  // False at the end of the walk.
  const auto step = [&workspace](Walk& walk) {
    HullPlace& place = walk.place;
    const VoronoiVertex& vertex = workspace.vertices[place.at];
    if (vertex.forming_points[3] == kInfinitePoint) return false;
    const Index across = vertex.forming_points[index_of(vertex.neighbors, place.from)];
    if (!walk.plane.is_certainly_above(workspace.points[across])) {
      walk.edge->doubtful = place;
      return false;
    }
    place = {vertex.neighbors[index_of(vertex.forming_points, place.behind)], place.at, across};
    __builtin_prefetch(&workspace.vertices[place.at]);
    return true;
  };
  std::array<Walk, kWalks> walks;
  std::size_t next = 0, count = 0;
  do {
    while (count < kWalks && next < edges.size()) walks[count++] = begin(edges[next++]);
    for (std::size_t w = 0; w < count;)
      if (step(walks[w]))
        ++w;
      else
        walks[w] = walks[--count];
  } while (count > 0 || next < edges.size());
}

}  // namespace orchard::detail
