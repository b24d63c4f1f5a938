#pragma once
#include <array>
#include <functional>
#include <vector>

#include "float4.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Every triangle that may contain the point of the surface nearest to a query, and possibly a few more that floats
// cannot exclude.
struct NearestTriangles {
  std::array<Index, 16> triangles;
  std::size_t count = 0;
  bool complete = false;  // whether all of them are listed
};

// A tree with four children a node over the triangles of a mesh, for distance queries. The bounds of a child are a box,
// and a slab across the mean normal of its triangles, cut to a disk around the middle of the box. A part of the surface
// that is oblique to the axes is much thinner than its box, and for a place above it, the box alone could not exclude
// what lies next to it. Bounds and flattened triangles are floats relative to the centre of the mesh, scaled to size
// one, and only select the triangles that can matter. These few are then measured by closest_point_of_triangle, so a
// result has the same bits as that of a loop over all triangles.
class TriangleTree {
 public:
  // Keeps a reference to `mesh`. Precondition: at least one triangle.
  explicit TriangleTree(const TriangleMesh& mesh);

  ClosestPoint closest(const Point& query) const;
  ClosestPoint closest(const Point& query, NearestTriangles& nearest) const;
  // Returns the same if it is within `distance`; otherwise an infinite distance and no triangle.
  ClosestPoint closest_within(const Point& query, double distance) const;
  // Returns how often the surface winds around the query. It is exact if the mesh is closed and consistently oriented
  // and the query is not on it. Precondition: the query lies in the mesh's box.
  int winding_number(const Point& query) const;
  void visit_nearest(const Point& query, const std::function<double(Index)>& visit) const;         // see Surface
  double max_reach(const std::array<Sphere, 3>& balls, const Point& middle, double enough) const;  // see Surface
  void near(const Sphere& ball, std::vector<Index>& out) const;  // ascending; cleared first
  void near(const Sphere& ball, const std::function<bool(const Box&)>& is_out,
            std::vector<Index>& out) const;                                               // see Surface
  void overlapping(const std::array<Point, 3>& triangle, std::vector<Index>& out) const;  // ascending; cleared first
  // Visits every two triangles whose boxes meet, once, and some others. The time is linear in the number of pairs if
  // the mesh is well shaped.
  void visit_pairs(const std::function<void(Index, Index)>& visit) const;

 private:
  struct Node {
    Float4 lower[3], upper[3];
    Float4 normal[3], low, high;  // of length one or 0, and the range along it
    Float4 radius;                // the extent across the normal, around the middle of the box
    Index child[4];               // into nodes_, or kLeaf + an index into leaves_
  };
  // Triangle k in a frame (origin, u, v, n) with its longest edge on the first axis: its corners are (0, 0), (base, 0)
  // and (foot, height).
  struct Leaf {
    Float4 origin[3], u[3], v[3], n[3];
    // The last two are those of the squared lengths of the edges to the apex.
    Float4 base, foot, height, inverse_left, inverse_right;
    Index triangle[4];  // kNone for an empty place
  };
  struct Query {
    Float4 p[3];
  };
  class Builder;
  class Candidates;
  class Pairs;
  class TriangleQuery;
  class Ray;
  class Reach;

  bool localize(const Point& point, Query& query) const;
  // The middle of each child's box.
  static Float4 middle(const Node& node, int axis) {
    return Float4{0.5f, 0.5f, 0.5f, 0.5f} * (node.lower[axis] + node.upper[axis]);
  }
  Float4 squared_distances(const Query& query, const Node& node, float limit) const;
  static Float4 squared_distances(const Query& query, const Leaf& leaf);
  void prefetch(Index child) const;
  void find_candidates(const Point& point, Candidates& candidates) const;
  template <class Visit, class IsOut>
  void visit_leaves(const Query& query, const float& limit, Visit visit, IsOut is_out) const;
  template <class Visit>
  void visit_leaves(const Query& query, const float& limit, Visit visit) const;
  template <class IsOut>
  void near_where(const Sphere& ball, IsOut is_out, std::vector<Index>& out) const;
  Box box_around(const Node& node, int lane) const;
  std::array<Point, 3> corners(Index triangle) const;
  ClosestPoint measure(const Point& query, Index triangle) const;

  const TriangleMesh& mesh_;
  bool is_fine_;
  Point center_ = Point::Zero();
  double scale_ = 1;  // a power of two
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace orchard::detail
