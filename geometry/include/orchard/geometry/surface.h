#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "orchard/geometry/clusters.h"
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/mesh_check.h"

namespace orchard {

// Which part of a triangle a point lies on. Edge i joins corners i and (i + 1) % 3.
enum class Feature : std::uint8_t { face, edge0, edge1, edge2, vertex0, vertex1, vertex2 };

struct ClosestPoint {
  Point position;
  double distance = 0;  // >= 0
  Index triangle = kNone;
  Feature feature = Feature::face;
};

// Which ball stands for the whole (min_ball.h): it is the root of sphere-trees and the length R of tolerances.
enum class BoundingBall : std::uint8_t { minimal, ritter };

// One surface, immutable and safe to query from many threads: a mesh with its adjacency, its clusters and a spatial
// index. Any triangles will do for distances; what has an inside is solid().
class Surface {
 public:
  // O(n log n). Throws InputError if validate(mesh) does.
  explicit Surface(TriangleMesh mesh, BoundingBall kind = BoundingBall::minimal);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  const TriangleMesh& mesh() const;
  const MeshReport& report() const;
  bool solid() const { return report().solid(); }
  const Box& bounding_box() const;
  const Sphere& bounding_ball() const;  // holds every vertex
  BoundingBall ball_kind() const;
  double bounding_radius() const { return bounding_ball().radius; }

  std::array<Point, 3> corners(Index triangle) const;
  const Vector& normal(Index triangle) const;  // unit, outward; zero for a degenerate triangle
  double area(Index triangle) const;
  // Triangle on the other side of edge i; kNone at a boundary or where more than two triangles meet.
  const std::array<Index, 3>& neighbors(Index triangle) const;
  std::span<const Index> triangles_around(Index vertex) const;  // ascending
  // The triangles that share a feature: one for a face, two for an edge, the fan for a vertex. Cleared first.
  void triangles_at(Index triangle, Feature feature, std::vector<Index>& out) const;
  const Clusters& clusters() const;  // coplanar ones, tolerance::kCoplanarAngle

  // Angle-weighted pseudonormal, unit length (Baerentzen and Aanaes 2005): where the surface faces. What is inside it
  // does not decide, since next to a surface that cuts itself it may point either way.
  Vector pseudonormal(Index triangle, Feature feature) const;

  // The nearest point; ties go to the lowest triangle; infinitely far if the query is not finite. O(log n).
  ClosestPoint closest(const Point& query) const;
  double distance(const Point& query) const { return closest(query).distance; }
  // The same where it is within `distance`, else infinitely far, on no triangle: many times as fast where there is
  // nothing so near.
  ClosestPoint closest_within(const Point& query, double distance) const;
  // Inside is, for all of orchard, where the winding number is above 1/2: places that the surface surrounds, however
  // often, and in whatever way it cuts itself. The solid is the surface and its inside. Negative inside, and
  // 1-Lipschitz; the sign is exact, the distance but for a few roundings of the coordinates. About the cost of
  // closest(); the first call also finds the self-intersections. Throws InputError unless solid().
  double signed_distance(const Point& query) const;
  double signed_distance(const Point& query, ClosestPoint& nearest) const;
  bool inside(const Point& query) const { return signed_distance(query) < 0; }
  // How often the surface winds around the query, counter-clockwise seen from outside: exact unless the query is on the
  // surface, where it is that of some place beside the query. By signed crossings of a ray; a few log n. Throws
  // InputError unless solid().
  int winding_number(const Point& query) const;
  // Those of the mesh (self_intersections.h), found at the first call.
  const std::vector<std::array<Index, 2>>& self_intersections() const;
  // A bound on how far any ball that is interpolated linearly on these three reaches beyond the place of the surface
  // that is nearest to its centre, whatever the side: of radius less distance. Not below `enough`: what is no more than
  // that is not looked at closely. `middle`, a place between the centres, is where the distance is linearised: the
  // bound is the better the smaller the three's triangle is beside the distance. A few log n; infinity where the balls
  // are far outside the surface or far larger.
  double max_reach(const std::array<Sphere, 3>& balls, const Point& middle, double enough) const;
  // Calls visit(triangle) for the triangles that are no farther from the query than it returned last, near ones first
  // as far as a tree of boxes tells: for searches of the nearest place that is not just any. Those beyond may come,
  // too.
  void visit_nearest(const Point& query, const std::function<double(Index)>& visit) const;
  // Triangles that touch the closed ball, ascending; `out` is cleared first.
  void triangles_near(const Sphere& ball, std::vector<Index>& out) const;
  // The same, but for triangles in boxes that `is_out` is true of: it is asked about boxes around ever fewer triangles,
  // and where it is true of one, none of these is looked at. It may be true of the boxes of any triangles.
  void triangles_near(const Sphere& ball, const std::function<bool(const Box&)>& is_out, std::vector<Index>& out) const;
  // Triangles that share a point with the closed triangle, ascending; `out` is cleared first. Exact, as triangles_meet.
  void triangles_overlapping(const std::array<Point, 3>& triangle, std::vector<Index>& out) const;

 private:
  struct Data;
  void require_inside() const;
  std::unique_ptr<const Data> data_;
};

// The point of triangle (a, b, c) nearest to `query` (dissertation 5.3.2, three cases). Works for degenerate triangles.
ClosestPoint closest_point_of_triangle(const Point& query, const Point& a, const Point& b, const Point& c);

// Whether two closed triangles share a point: exact for the coordinates given, touching, coplanar and degenerate
// triangles (segments, points) included.
bool triangles_meet(const std::array<Point, 3>& a, const std::array<Point, 3>& b);

}  // namespace orchard
