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
// collapses. Vertices keep their numbers; those that are gone are not alive.
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
  // Both become a, with this ball. Precondition: may_contract(a, b).
  void contract(Index a, Index b, const Ball4& ball);
  // A new vertex on an edge. Returns its number.
  Index divide(Index a, Index b, const Ball4& ball);
  // A new vertex, joined to one, or by a triangle to an edge's two. Returns its number.
  Index extend(Index a, const Ball4& ball);
  Index extend(Index a, Index b, const Ball4& ball);
  // Takes away an edge, and the only triangle at it: an elementary collapse. Returns the third corner.
  // Precondition: count_triangles_at(a, b) == 1.
  Index collapse(Index a, Index b);
  // A triangle on two edges, and the edge that they lack: undoes collapse(a, b), which returned c.
  void expand(Index a, Index b, Index c) { add_triangle(a, b, c); }
  // For meshes without an edge that may be contracted: takes triangles away, each with an edge that has no other, which
  // are elementary collapses, until there is one. False if there is nothing left to take.
  bool make_contractible();

  // For meshes without an edge that may be contracted, such as rings that share a vertex: lays one edge onto another
  // with which it shares a vertex, the nearest two, so that there is one vertex less: an elementary expansion, a
  // triangle between the two, and a contraction. False if no two may be: where the others ends have more than that
  // vertex in common.
  bool fold();

  // The living cells, vertices renumbered in their order.
  MedialMesh mesh() const;
  // The living triangles.
  std::vector<Triangle> triangles() const;
  // For each of its cells that no larger one holds, its corners by the numbers here; missing ones repeat the first.
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
