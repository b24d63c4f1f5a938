#pragma once
#include <array>
#include <limits>
#include <vector>

#include "orchard/medial/medial_mesh.h"
#include "support_tree.h"

namespace orchard::detail {

// The solid that a medial mesh stands for: the union of all balls whose centre and radius are interpolated on its
// vertices, edges (cones) and triangles (slabs).
class Reconstruction {
 public:
  explicit Reconstruction(const MedialMesh& mesh);

  // Makes it that of a mesh of which most cells are those of the mesh before, vertices by the same numbers: O(n), with
  // a tree of what is new alone. Cells get other numbers.
  void change(const MedialMesh& mesh);

  // The least |query - centre| - radius over all those balls: the distance to the union outside, and minus the depth in
  // the deepest single ball inside, which is at most the depth in the union. 1-Lipschitz.
  double distance(const Point& query) const;
  // The ball of which that is the distance; ties go to the first found.
  double distance(const Point& query, Sphere& ball) const;
  // The same where it is below `bound`, which saves looking for what is not; else `bound`, and `ball` stays.
  double distance_below(double bound, const Point& query, Sphere& ball) const;
  // The same, but any value below `enough`, with its ball, will do where there are such.
  double distance_between(double enough, double bound, const Point& query, Sphere& ball) const;

  // distance(query), with its ball and the cell that has it: a triangle, or an edge or a vertex that no larger cell
  // holds.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Sphere ball{Point::Zero(), 0};
    Index cell = kNone;  // if there is none
  };
  // The nearest of all; any below `enough` will do where there are such.
  Nearest nearest(const Point& query, double enough = -std::numeric_limits<double>::infinity()) const;
  // Of one cell.
  Nearest nearest_in(Index cell, const Point& query) const;
  // The nearest of all, where a cell is known already: it comes back unless one is nearer. Its ball is not looked at.
  Nearest nearest_from(Nearest known, const Point& query, double enough) const;
  // The vertices of a cell; smaller ones repeat their last.
  const std::array<Index, 3>& corners_of(Index cell) const { return corners_[cell]; }
  // The least |query - centre| - radius over the balls of one cell. They are those in the convex hull of its corners'
  // balls, so it is a convex function of the query: nowhere on a triangle is it more than at the corners.
  // At least `best`, but not exact, where it is not below.
  double distance_to_cell(Index cell, const Point& query, double best = std::numeric_limits<double>::infinity()) const;
  // Numbers of cells are below it. Before a change there are so many.
  Index cells() const { return static_cast<Index>(corners_.size()); }

 private:
  // Some of the cells, from number `first` on: triangles, edges and vertices that no larger cell holds, in this order.
  struct Part {
    Index first = 0, size = 0, triangles = 0, edges = 0;
    SupportTree tree;
  };

  Part part_of(const MedialMesh& mesh, const std::vector<std::array<Index, 3>>& cells);
  // The least of `best` and what is found, which improved(value, cell, ball) is told.
  template <class Improved>
  double search(const Point& query, double best, double enough, const Improved& improved) const;
  // The least for a cell, and the ball; a value that is `best` or more need not be exact.
  static double evaluate(const Part& part, Index item, const SupportTree::Item& balls, const Point& query, double best,
                         Sphere& ball);
  double evaluate(Index cell, const Point& query, double best, Sphere& ball) const;

  std::vector<std::array<Index, 3>> corners_;  // of each cell
  std::vector<Sphere> balls_;                  // of each vertex
  Part first_, changed_;                       // what there was first, and what came by changes
  std::vector<std::uint8_t> gone_;             // of what there was first; nothing before a change
};

// The ball of a cell that comes nearest to `query`, for cells of one, two or three vertices.
Sphere nearest_ball(const Point& query, const Sphere& a, const Sphere& b);
Sphere nearest_ball(const Point& query, const Sphere& a, const Sphere& b, const Sphere& c);

}  // namespace orchard::detail
