#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "../balls/ball_complex.h"

namespace orchard::detail {

// Where a vertex of a medial complex is, or the inside of an edge. A junction is all that is none of the others: the
// end of a seam or a curve, where sheets touch in one point, a corner of a border.
enum class Stratum : std::uint8_t { junction, curve, border, seam, sheet };

// A medial complex that is changed cell by cell. Cells are what no larger cell holds: triangles, bare edges, which
// repeat their last corner, and lone vertices, which repeat it twice.
class SheetMesh {
 public:
  using Cell = std::array<Index, 3>;
  using Edge = std::array<Index, 2>;

  explicit SheetMesh(const BallComplex& complex);
  // Without what is gone, complete; vertices in their order.
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
  // What keeps its place; it is a junction.
  void pin(Index v);

  Index add(const Cell& cell);
  void remove(Index cell);
  // Undoes: a removed cell comes back under its number; the last cells, from `first` on, go with their numbers.
  void put_back(Index cell, const Cell& corners);
  void take_back(Index first);

  Stratum stratum(Index v) const;
  // Of an edge of a cell; seams and borders are so by the number of their triangles.
  Stratum stratum(Index a, Index b) const;
  bool has_edge(Index a, Index b) const;
  // The vertices that an edge joins to this one, ascending.
  void neighbors(Index v, std::vector<Index>& out) const;
  // Those joined to it by edges of the vertex's own stratum: two, but for junctions and in sheets.
  void neighbors_along(Index v, std::vector<Index>& out) const;
  // The corners of the triangles at an edge that are not on it.
  void opposite(Index a, Index b, std::vector<Index>& out) const;
  // Edges of cells, ascending, each once: all, or those between vertices that are marked.
  std::vector<Edge> edges(std::span<const std::uint8_t> of = {}) const;

  // Whether drawing an edge together to a point changes no topology: what both ends' cells meet is on the edge (the
  // link condition; Attali, Lieutier and Salinas 2012).
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
