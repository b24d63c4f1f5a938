#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../balls/ball_complex.h"

namespace orchard::detail {

// What a vertex of a medial complex, or the inside of an edge, belongs to. A vertex that belongs to none of the others
// is a junction, as in structure.h; so is a vertex that was pinned, such as a corner of a border.
enum class Stratum : std::uint8_t { junction, curve, border, seam, sheet };

// A medial complex that is changed cell by cell. Its cells are those that are part of no larger one: triangles, bare
// edges (their last corner is repeated) and lone vertices (repeated twice).
class SheetMesh {
 public:
  using Cell = std::array<Index, 3>;
  using Edge = std::array<Index, 2>;

  explicit SheetMesh(const BallComplex& complex);
  // The complex as it is now, with all edges of triangles, without removed vertices; the others keep their order.
  BallComplex complex() const;

  Index vertices() const { return static_cast<Index>(balls_.size()); }
  const ExactBall& ball(Index v) const { return balls_[v]; }
  const Point& center(Index v) const { return balls_[v].center; }
  void set_ball(Index v, const ExactBall& ball) { balls_[v] = ball; }
  Index add_vertex(const ExactBall& ball);

  Index cells() const { return static_cast<Index>(cells_.size()); }
  bool alive(Index cell) const { return cells_[cell][0] != kNone; }
  const Cell& corners(Index cell) const { return cells_[cell]; }
  std::span<const Index> cells_at(Index v) const { return cells_at_[v]; }
  bool has(Index v) const { return !cells_at_[v].empty(); }
  // Makes a vertex a junction whatever is around it, so that it keeps its place.
  void pin(Index v);

  Index add(const Cell& cell);
  void remove(Index cell);
  // Undo remove() and add(): put_back() gives a removed cell its number back; take_back() removes the cells from number
  // `first` on and frees their numbers.
  void put_back(Index cell, const Cell& corners);
  void take_back(Index first);

  Stratum stratum(Index v) const;
  // Of an edge of a cell: the number of triangles at it tells curves, borders, sheets and seams apart.
  Stratum stratum(Index a, Index b) const;
  bool has_edge(Index a, Index b) const;
  // The vertices that share an edge with this one, ascending.
  void neighbors(Index v, std::vector<Index>& out) const;
  // The neighbours along edges of the vertex's own stratum: two for a vertex of a curve, border or seam.
  void neighbors_along(Index v, std::vector<Index>& out) const;
  // The third corners of the triangles at an edge.
  void opposite(Index a, Index b, std::vector<Index>& out) const;
  // The edges of all cells, ascending, each once; with `of`, only those between vertices that it marks.
  std::vector<Edge> edges(std::span<const std::uint8_t> of = {}) const;

  // Whether contracting an edge to a point keeps the topology. The test is the link condition (Attali, Lieutier and
  // Salinas 2012): the links of the two ends meet only in the link of the edge.
  bool contractible(Index a, Index b) const;

 private:
  void enter(Index cell);
  Stratum find_stratum(Index v) const;

  std::vector<ExactBall> balls_;
  std::vector<Cell> cells_;
  std::vector<std::vector<Index>> cells_at_;
  std::vector<std::uint8_t> pinned_;
  mutable std::vector<std::uint8_t> stratum_;  // a Stratum, or kUnknown
};

inline bool is_triangle(const SheetMesh::Cell& cell) { return cell[1] != cell[2]; }

}  // namespace orchard::detail
