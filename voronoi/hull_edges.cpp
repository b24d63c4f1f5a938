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

struct Walk {
  FacetPlane plane;
  HullPlace place;
  HullEdge* edge;
};

}  // namespace

void note_convex(const Workspace& workspace, std::span<HullEdge> edges) {
  const auto begin = [&workspace](HullEdge& edge) {
    const VoronoiVertex& vertex = workspace.vertices[edge.v];
    const auto corner = [&](unsigned i) -> const Point& { return workspace.points[vertex.forming_points[i]]; };
    return Walk{{corner(0), corner(1), corner(2)}, HullPlace::first(vertex, edge.v, edge.slot), &edge};
  };
  // False at the end of the walk.
  const auto step = [&workspace](Walk& walk) {
    HullPlace& place = walk.place;
    const VoronoiVertex& vertex = workspace.vertices[place.at];
    if (vertex.forming_points[3] == kInfinitePoint) {
      walk.edge->convex = true;
      return false;
    }
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
