#pragma once
#include <array>
#include <span>
#include <vector>

#include "../balls/exact_ball.h"
#include "../extend/sharp_ends.h"
#include "../features/sharp_edges.h"
#include "cell_errors.h"
#include "cover_samples.h"
#include "mesh_change.h"
#include "remesh.h"
#include "sheet_mesh.h"
#include "triangle_shape.h"

namespace orchard::detail {

// The steps of remesh(). Each checks every change before it makes it: no triangle folds over, bad triangles do not get
// worse, interpolated balls stay right, and the part of the surface that is covered stays covered.
class Remesher {
 public:
  Remesher(const Surface& surface, std::span<const Point> places, const BallComplex& complex,
           std::span<const std::uint8_t> where, const RemeshOptions& options);

  void run(const Progress& progress);
  BallComplex complex() const { return mesh_.complex(); }
  Index moved() const { return moved_; }

 private:
  using Cell = SheetMesh::Cell;
  using Edge = SheetMesh::Edge;

  // A change may make triangles worse as long as their quality stays above this.
  static constexpr double kGoodQuality = 0.4;
  // Over the target length: longer edges are split, and shorter ones are collapsed (as in Botsch and Kobbelt 2004; the
  // band is narrower here because that gives more even triangles).
  static constexpr double kLong = 5.0 / 4, kShort = 0.85;
  // Of the smallest target length: vertices nearer than this count as being at the same place.
  static constexpr double kOnePlace = 0.5;

  // remesh.cpp
  void widen();
  void pin_corners();
  double length(Index a, Index b) const { return (mesh_.center(a) - mesh_.center(b)).norm(); }
  double target(Index a, Index b) const { return std::min(target_[a], target_[b]); }
  bool on_surface(Index v) const { return !(mesh_.ball(v).radius > 0); }
  bool is_bare(Index a, Index b) const { return mesh_.stratum(a, b) == Stratum::curve; }
  bool is_open(const Cell& cell) const { return open_[cell[0]] != 0 && open_[cell[1]] != 0 && open_[cell[2]] != 0; }
  std::vector<Edge> open_edges() const { return mesh_.edges(open_); }
  std::vector<Index> cells_at(Index v) const { return {mesh_.cells_at(v).begin(), mesh_.cells_at(v).end()}; }
  std::vector<Index> cells_at_edge(Index a, Index b) const;
  ExactBall middle(Index a, Index b);
  bool is_covered(const MeshChange& change, std::span<const Index> made, std::span<const Index> touched) {
    return cover_.stay_covered(mesh_, change.old(), made, touched);
  }
  void keep(MeshChange& change, std::span<const Index> made);

  // drop_small_sheets.cpp
  void drop_small_sheets();
  void trim();
  bool drop(const std::vector<Index>& triangles);
  void drop_dangling(Index first);
  bool drop_end(Index edge);

  // split_edges.cpp
  void split_long();
  void split_wrong();
  bool split(Index a, Index b);

  // collapse_edges.cpp
  void collapse_short();
  bool may_go(Index v, Index to) const;
  bool may_become(Index v, Index other) const;
  bool is_one_place(double length) const { return length < kOnePlace * options_.min_length; }
  int contacts_of(Index v) const { return mesh_.ball(v).exact ? mesh_.ball(v).count : 0; }
  bool collapse(Index a, Index b);
  bool draw(Index a, Index b, const ExactBall& ball);

  // flip_edges.cpp
  void flip();
  bool flip(Index a, Index b);

  // smooth_vertices.cpp
  void smooth();
  bool smooth_in_sheet(Index v);
  bool smooth_border(Index v);
  bool smooth_along(Index v);
  bool slide(Index v);
  bool move(Index v, const Vector& step, const Vector* normal);
  int contacts_wanted(Index v) const;
  std::vector<ClosestPoint> contacts_near(Index v, const Vector* normal) const;
  bool put(Index v, const ExactBall& ball);
  bool stays_well_shaped(std::span<const Index> cells, Index v, const ExactBall& ball_before);
  bool stays_right(std::span<const Index> cells, Index v, const ExactBall& ball_before);

  const Surface& surface_;
  const RemeshOptions& options_;
  SheetMesh mesh_;
  CellErrors errors_;
  CoverSamples cover_;
  BallSolver solver_;
  SharpEdges sharp_;
  std::vector<double> target_;        // of each vertex: the target length of its edges, in mesh units
  std::vector<std::uint8_t> open_;    // of each vertex: 1 if it may be changed
  std::vector<std::uint8_t> active_;  // of each vertex: 1 if something near it has changed since it was last moved
  Index moved_ = 0;                   // the number of moves of vertices
};

}  // namespace orchard::detail
