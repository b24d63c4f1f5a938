#pragma once
#include <span>
#include <vector>

#include "orchard/covering/path_forest.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A ball of the level in question and the path region that it lies in.
struct PlacedBall {
  Sphere sphere;
  Index path_region = kNone;
};

// A change that is tried: some balls are replaced by others.
struct Change {
  std::span<const Index> gone;
  std::span<const PlacedBall> added;
};

// The ends of an arc on the boundary of an uncovered piece of the surface; both are the same for a corner of a triangle
// in such a piece. The arcs in a triangle bulge into the piece, so the convex hull of the piece is that of these
// points.
struct OpenArc {
  Point begin, end;
};

// Computes exactly which part of the surface the path regions of a level leave uncovered, at present or after a change
// of a few balls. Const functions may run in parallel, each with a scratch of its own.
class LevelCover {
 public:
  struct Scratch {
    NearBalls near;
    std::vector<Index> triangles;
    std::vector<Index> open;  // the triangles of the last open_arcs() that have such arcs
  };

  // `upper`: the tree above the level, with leaves where it has leaves already; path_ends[r]: the last ball on the
  // path of path region r in it, kNone if that is not to be used.
  LevelCover(const Surface& surface, std::span<const PathBall> upper, std::vector<Index> path_ends,
             std::vector<PlacedBall> balls);

  std::span<const PlacedBall> balls() const { return balls_; }
  void replace(Index ball, const PlacedBall& by);
  bool in_path_region(Index path_region, const Point& point) const;

  // Finds the triangles that would not be covered without these balls, ascending. Precondition: they are covered with
  // them.
  void triangles_resting_on(std::span<const Index> balls, Scratch& scratch, std::vector<Index>& triangles) const;
  // Finds the triangles near a ball, ascending, without most of those that one path without this ball certainly
  // contains.
  void triangles_near(Index ball, std::vector<Index>& triangles) const;
  // Appends the arcs around the parts of some triangles that are uncovered inside the closed sphere after the change;
  // the second function only returns whether there are none.
  void open_arcs(std::span<const Index> triangles, const Sphere& where, const Change& change, Scratch& scratch,
                 std::vector<OpenArc>& arcs) const;
  bool covered(std::span<const Index> triangles, const Sphere& where, const Change& change, Scratch& scratch) const;

 private:
  void gather(const std::array<Point, 3>& corners, const Sphere& where, const Change& change, NearBalls& near) const;
  std::vector<Index> others_near(Index ball) const;
  void find_others_near(Index ball, std::span<const Index> upper, std::vector<Index>& others) const;
  bool path_holds(Index path_region, const Box& box) const;

  const Surface& surface_;
  const double margin_;
  PathForest upper_;
  std::vector<Index> path_ends_, region_at_;
  std::vector<PlacedBall> balls_;
  std::vector<std::vector<Index>> balls_in_;  // by path region
};

}  // namespace orchard::detail
