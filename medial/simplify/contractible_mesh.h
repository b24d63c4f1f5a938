#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

using Ball4 = Eigen::Vector4d;  // centre and radius

inline Ball4 ball4(const Point& center, double radius) { return {center.x(), center.y(), center.z(), radius}; }

// A medial mesh that changes by steps which keep its homotopy type, and so its Betti numbers: contractions of edges
// under the link condition (Attali, Lieutier, Salinas 2012), divisions of edges, free extensions and elementary
// collapses. Vertices keep their numbers; a vertex that was contracted into another is no longer alive.
class ContractibleMesh {
 public:
  using Triangle = std::array<Index, 3>;

  explicit ContractibleMesh(const MedialMesh& mesh);

  Index size() const { return static_cast<Index>(balls_.size()); }  // of numbers that were ever given
  Index living() const { return living_; }
  bool alive(Index vertex) const { return alive_[vertex] != 0; }
  const Ball4& ball(Index vertex) const { return balls_[vertex]; }
  void set_ball(Index vertex, const Ball4& ball) { balls_[vertex] = ball; }
  std::span<const Index> neighbors(Index vertex) const { return neighbors_[vertex]; }  // ascending
  std::span<const Index> triangles_at(Index vertex) const { return triangles_at_[vertex]; }
  const Triangle& triangle(Index triangle) const { return triangles_[triangle]; }  // of a living one
  bool adjacent(Index a, Index b) const;
  // The third corners of the triangles at an edge; `out` is cleared first.
  void opposite(Index a, Index b, std::vector<Index>& out) const;
  Index count_triangles_at(Index a, Index b) const;

  // The link condition: the links of a and b meet in that of their edge. Precondition: they are adjacent.
  bool may_contract(Index a, Index b) const;
  // Contracts the edge to vertex a, which gets this ball. Precondition: may_contract(a, b).
  void contract(Index a, Index b, const Ball4& ball);
  // Divides an edge, and the triangles at it, by a new vertex. Returns its number.
  Index divide(Index a, Index b, const Ball4& ball);
  // Adds a vertex that is joined to a vertex by an edge, or to an edge by a triangle. Returns its number.
  Index extend(Index a, const Ball4& ball);
  Index extend(Index a, Index b, const Ball4& ball);
  // Removes an edge and the only triangle at it: an elementary collapse. Returns the triangle's third corner.
  // Precondition: count_triangles_at(a, b) == 1.
  Index collapse(Index a, Index b);
  // Undoes collapse(a, b), which returned c: adds the edge ab and the triangle abc.
  void expand(Index a, Index b, Index c) { add_triangle(a, b, c); }
  // For meshes in which no edge may be contracted: removes triangles by elementary collapses until an edge may be.
  // Returns false if no triangle is left that can be collapsed.
  bool make_contractible();

  // For meshes in which no edge may be contracted, such as rings that share a vertex: merges two edges that share a
  // vertex, so that there is one vertex less. Of all such pairs, it takes the one whose other ends are nearest. This is
  // an elementary expansion (a triangle between the two edges) followed by a contraction. Two edges can be merged only
  // if their other ends are not adjacent and have no other neighbour in common. Returns false if there are no such two.
  bool merge_edges();

  // The cells that are alive, with vertices renumbered in their order.
  MedialMesh mesh() const;
  // The triangles that are alive.
  std::vector<Triangle> triangles() const;
  // The cells that are part of no larger one: their corners, by the numbers of this mesh. Edges and vertices repeat the
  // first corner to have three.
  std::vector<Triangle> maximal_cells() const;

 private:
  bool has_contractible_edge() const;
  bool take_free_triangle();
  Index add_vertex(const Ball4& ball);
  void add_triangle(Index a, Index b, Index c);
  void remove_triangle(Index triangle);
  void join(Index a, Index b);
  void part(Index a, Index b);

  std::vector<Ball4> balls_;
  std::vector<std::uint8_t> alive_;
  std::vector<std::vector<Index>> neighbors_, triangles_at_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> triangle_alive_;
  std::vector<Index> free_triangles_;  // numbers of triangles to give again
  Index living_ = 0;
};

}  // namespace orchard::detail
