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

// A change that is being tried: some balls are gone, and others are there instead.
struct Change {
  std::span<const Index> gone;
  std::span<const PlacedBall> added;
};

// The ends of an arc that bounds a piece of surface without a path, or a corner in such a piece twice. In each triangle
// these arcs bulge into the piece, so its convex hull is that of such points.
struct OpenArc {
  Point begin, end;
};

// Says exactly which part of the surface the path regions of a level leave uncovered, and which part they would leave
// after a change to a few balls. Const functions may run in parallel, each with its own scratch.
class LevelCover {
 public:
  struct Scratch {
    NearBalls near;
    std::vector<Index> triangles;
    std::vector<Index> open;  // of the triangles that open_arcs() looked at, those with any
  };

  // `upper`: the tree above the level, with leaves where it has leaves already; path_ends[r]: the last ball on the
  // path of path region r in it, kNone if that is not to be used.
  LevelCover(const Surface& surface, std::span<const PathBall> upper, std::vector<Index> path_ends,
             std::vector<PlacedBall> balls);

  std::span<const PlacedBall> balls() const { return balls_; }
  void replace(Index ball, const PlacedBall& by);
  bool in_path_region(Index path_region, const Point& point) const;

  // The triangles that would not be covered without these balls, ascending. Precondition: they are with them.
  void triangles_resting_on(std::span<const Index> balls, Scratch& scratch, std::vector<Index>& triangles) const;
  // Those near a ball, ascending, but for most of those that one path without that ball surely holds.
  void triangles_near(Index ball, std::vector<Index>& triangles) const;
  // Appends what of some triangles is uncovered inside the closed sphere after the change; or says whether nothing is.
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
  std::vector<std::vector<Index>> balls_in_;  // each path region
};

}  // namespace orchard::detail
