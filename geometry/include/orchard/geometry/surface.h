#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "orchard/geometry/clusters.h"
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/mesh_check.h"

// A triangle mesh with everything that is queried about it: adjacency, clusters, distances and inside-outside tests.
namespace orchard {

// The part of a triangle that a point lies on. Edge i joins corners i and (i + 1) % 3.
enum class Feature : std::uint8_t { face, edge0, edge1, edge2, vertex0, vertex1, vertex2 };

// The point of a surface that is nearest to a query.
struct ClosestPoint {
  Point position;
  double distance = 0;  // The distance to the query in mesh units, at least 0.
  Index triangle = kNone;
  Feature feature = Feature::face;
};

// The kind of ball that bounds the mesh (min_ball.h). This ball is the root of sphere-trees, and its radius is the
// length R of the tolerances.
enum class BoundingBall : std::uint8_t { minimal, ritter };

// One immutable surface: a mesh with its adjacency, its clusters and a spatial index. All queries may run on many
// threads at once. Distances are defined for any triangles; inside and outside are defined only if solid() holds.
class Surface {
 public:
  // Builds the adjacency and the spatial index of a mesh. Throws InputError if validate(mesh) does. O(n log n).
  explicit Surface(TriangleMesh mesh, BoundingBall kind = BoundingBall::minimal);
  ~Surface();
  Surface(Surface&&) noexcept;
  Surface& operator=(Surface&&) noexcept;

  const TriangleMesh& mesh() const;
  // Returns the counts of faults that check_mesh() found.
  const MeshReport& report() const;
  bool solid() const { return report().solid(); }
  const Box& bounding_box() const;
  const Sphere& bounding_ball() const;  // Returns a ball that contains every vertex.
  BoundingBall ball_kind() const;
  double bounding_radius() const { return bounding_ball().radius; }

  std::array<Point, 3> corners(Index triangle) const;
  const Vector& normal(Index triangle) const;  // The outward unit normal; zero for a degenerate triangle.
  double area(Index triangle) const;           // The area of a triangle, in squared mesh units.
  // Returns, for each edge i, the triangle on its other side, or kNone at a boundary or where more than two triangles
  // meet.
  const std::array<Index, 3>& neighbors(Index triangle) const;
  // Returns the triangles with this vertex as a corner, ascending.
  std::span<const Index> triangles_around(Index vertex) const;
  // Replaces the contents of `out` by the triangles that share a feature: one for a face, two for an edge, the whole
  // fan for a vertex.
  void triangles_at(Index triangle, Feature feature, std::vector<Index>& out) const;
  // Returns the sets of adjacent coplanar triangles, with normals within tolerance::kCoplanarAngle.
  const Clusters& clusters() const;

  // Returns the angle-weighted unit pseudonormal of a feature, which is the direction that the surface faces there. Do
  // not use it to decide what is inside: beside a surface that cuts itself it may point either way. Source: Baerentzen
  // and Aanaes 2005.
  Vector pseudonormal(Index triangle, Feature feature) const;

  // Returns the point of the surface that is nearest to the query. If several triangles are equally near, the lowest
  // one is returned. If the query is not finite, the distance is infinite. O(log n).
  ClosestPoint closest(const Point& query) const;
  double distance(const Point& query) const { return closest(query).distance; }
  // Returns the nearest point if it is within `distance` (mesh units). Otherwise the distance is infinite and the
  // triangle is kNone. This is many times as fast as closest() where no triangle is that near.
  ClosestPoint closest_within(const Point& query, double distance) const;
  // Returns the distance to the surface, negative inside. The inside is where the winding number is above 1/2, in all
  // of orchard: it includes every place that the surface surrounds, however often, and in whatever way the surface cuts
  // itself. The solid is the surface and its inside.
  // The result is 1-Lipschitz. Its sign is exact, and its value is exact up to a few roundings of the coordinates.
  // Throws InputError unless solid(). Costs about as much as closest(); the first call also finds the
  // self-intersections.
  double signed_distance(const Point& query) const;
  // Does the same and also stores the nearest point.
  double signed_distance(const Point& query, ClosestPoint& nearest) const;
  bool inside(const Point& query) const { return signed_distance(query) < 0; }
  // Returns how often the surface winds around the query, counter-clockwise seen from outside, from signed crossings of
  // a ray. The result is exact; for a query on the surface it is the number of some place beside the query. Throws
  // InputError unless solid(). Costs a few log n.
  int winding_number(const Point& query) const;
  // Returns the pairs of triangles that cut each other (self_intersections.h). The first call computes them.
  const std::vector<std::array<Index, 2>>& self_intersections() const;
  // Returns an upper bound on the reach of all balls that are interpolated linearly on three balls. The reach of a ball
  // is its radius minus the distance of its centre to the surface, on either side: how far the ball extends beyond the
  // place of the surface that is nearest to its centre.
  // The bound is never below `enough`, because values up to `enough` are not searched closely. The distance is
  // linearised at `middle`, a place between the centres, and the bound is tighter if the triangle of centres is small
  // beside the distance. The result is infinity if the balls are far outside the surface or far larger than it. Costs a
  // few log n.
  double max_reach(const std::array<Sphere, 3>& balls, const Point& middle, double enough) const;
  // Calls visit(triangle) for every triangle within the distance that `visit` returned last, roughly in the order of
  // their distance. The callback may also get triangles beyond that distance. Use it to search for the nearest place
  // that satisfies a further condition.
  void visit_nearest(const Point& query, const std::function<double(Index)>& visit) const;
  // Replaces the contents of `out` by the triangles that touch the closed ball, ascending.
  void triangles_near(const Sphere& ball, std::vector<Index>& out) const;
  // Does the same without the triangles in boxes for which `is_out` returns true. The function calls `is_out` with
  // boxes around ever fewer triangles; if it returns true for a box, none of the triangles in the box is examined.
  // `is_out` may be true of any box around triangles.
  void triangles_near(const Sphere& ball, const std::function<bool(const Box&)>& is_out, std::vector<Index>& out) const;
  // Replaces the contents of `out` by the triangles that share a point with the closed triangle, ascending. The test is
  // exact, as that of triangles_meet().
  void triangles_overlapping(const std::array<Point, 3>& triangle, std::vector<Index>& out) const;

 private:
  struct Data;
  void require_inside() const;
  std::unique_ptr<const Data> data_;
};

// Returns the point of triangle (a, b, c) that is nearest to `query`. The triangle may be degenerate. Source:
// dissertation 5.3.2, three cases.
ClosestPoint closest_point_of_triangle(const Point& query, const Point& a, const Point& b, const Point& c);

// Returns whether two closed triangles share a point. The result is exact for the given coordinates, also for touching,
// coplanar and degenerate triangles (segments and points).
bool triangles_meet(const std::array<Point, 3>& a, const std::array<Point, 3>& b);

}  // namespace orchard
