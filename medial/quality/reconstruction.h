#pragma once
#include <array>
#include <limits>
#include <vector>

#include "orchard/medial/medial_mesh.h"
#include "support_tree.h"

namespace orchard::detail {

// The solid that a medial mesh represents: the union of all balls whose centre and radius are interpolated on its
// vertices, edges (cones) and triangles (slabs).
class Reconstruction {
 public:
  explicit Reconstruction(const MedialMesh& mesh);

  // Replaces the mesh by one that shares most cells with the mesh before, with the same numbers of vertices. Takes
  // O(n), and a tree is built for the new cells only. The numbers of cells change.
  void change(const MedialMesh& mesh);

  // Returns the smallest |query - centre| - radius over all those balls. Outside, this is the distance to the union;
  // inside, it is minus the depth in the deepest single ball, which is at most the depth in the union. 1-Lipschitz.
  double distance(const Point& query) const;
  // Also returns the ball that has this distance. Of equal ones, it is the first that the search finds.
  double distance(const Point& query, Sphere& ball) const;
  // Returns the same value if it is below `bound`, which shortens the search. Otherwise, it returns `bound`, and `ball`
  // stays as it is.
  double distance_below(double bound, const Point& query, Sphere& ball) const;
  // The same, but if some values are below `enough`, it returns any one of these with its ball.
  double distance_between(double enough, double bound, const Point& query, Sphere& ball) const;

  // The result of a search: distance(query) with its ball, and the cell that contains the ball, which is a triangle, or
  // an edge or a vertex that is part of no larger cell.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Sphere ball{Point::Zero(), 0};
    Index cell = kNone;  // kNone if there is none
  };
  // Returns the nearest cell of all, or any cell with a distance below `enough` if there are such.
  Nearest nearest(const Point& query, double enough = -std::numeric_limits<double>::infinity()) const;
  // Returns the distance to one cell.
  Nearest nearest_in(Index cell, const Point& query) const;
  // Returns the nearest cell of all if one cell is known already; that one is returned unless another is nearer. The
  // ball of `known` is not computed.
  Nearest nearest_from(Nearest known, const Point& query, double enough) const;
  // Returns the vertices of a cell. Smaller cells repeat their last vertex.
  const std::array<Index, 3>& corners_of(Index cell) const { return corners_[cell]; }
  // Returns the smallest |query - centre| - radius over the balls of one cell. These are the balls in the convex hull
  // of the balls at its corners, so the value is a convex function of the query, and on a triangle it is largest at a
  // corner. Values of `best` or more do not have to be exact.
  double distance_to_cell(Index cell, const Point& query, double best = std::numeric_limits<double>::infinity()) const;
  // Numbers of cells are below this. Before the first change, it is the number of cells.
  Index cells() const { return static_cast<Index>(corners_.size()); }

 private:
  // A part of the cells, from number `first` on: triangles, edges and vertices that are part of no larger cell, in this
  // order.
  struct Part {
    Index first = 0, size = 0, triangles = 0, edges = 0;
    SupportTree tree;
  };

  Part part_of(const MedialMesh& mesh, const std::vector<std::array<Index, 3>>& cells);
  // Searches for a smaller distance than `best`, and calls improved(value, cell, ball) for each that it finds.
  template <class Improved>
  double search(const Point& query, double best, double enough, const Improved& improved) const;
  // Returns the distance to a cell, and the ball. A value of `best` or more does not have to be exact.
  static double evaluate(const Part& part, Index item, const SupportTree::Item& balls, const Point& query, double best,
                         Sphere& ball);
  double evaluate(Index cell, const Point& query, double best, Sphere& ball) const;

  std::vector<std::array<Index, 3>> corners_;  // of each cell
  std::vector<Sphere> balls_;                  // of each vertex
  Part first_, changed_;                       // the cells of the first mesh, and those that later changes added
  std::vector<std::uint8_t> gone_;             // which cells of the first mesh are gone; empty before the first change
};

// Returns the ball of a cell that comes nearest to `query`, for cells with two or three vertices.
Sphere nearest_ball(const Point& query, const Sphere& a, const Sphere& b);
Sphere nearest_ball(const Point& query, const Sphere& a, const Sphere& b, const Sphere& c);

}  // namespace orchard::detail
