#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

// Meshes the surface where a function is zero. The mesh is closed and manifold, and faces the side where the function
// is positive.
//
// The signs at the corners of a grid decide. The cubes of the grid are halved where the function may be zero. Each of
// the smallest cubes is cut into six tetrahedra, which fit together; the part of the surface in each is one triangle or
// two, with corners on its edges. So the mesh is closed, manifold and without self-intersections for every function.
// - Parts thinner than a cell may be lost, and edges are cut off by less than a cell.
// - Values at places of the mesh differ from 0 by less than a cell, because such a place is nearer than that to a
//   corner of its triangle, where the value is 0 up to rounding.
// - A place whose value is more than sqrt(3) cells, the diameter of a cube, away from 0 is on the side of the mesh that
//   its sign tells.
class LevelSet {
 public:
  // `value` has to be 1-Lipschitz, safe to call from several threads, and positive outside `box`. `cell` is the edge
  // length of the smallest cubes; the box must be less than 2^20 of them wide.
  LevelSet(std::function<double(const Point&)> value, const Box& box, double cell, const Progress& progress,
           const char* stage);

  // Returns a mesh without triangles if no corner of the grid is inside. Parallel; the result is the same for any
  // number of threads.
  TriangleMesh mesh();

  // Call this after mesh(). Returns whether a part of the inside around `place` was lost, which is so if the surface
  // may pass through the cube there but no corner of it or of its neighbours is inside. Precondition: `place` is in the
  // box.
  bool lost_at(const Point& place) const;

 private:
  using Lattice = std::array<std::uint32_t, 3>;

  Point place(const Lattice& at) const;
  void find_cubes();
  void find_signs();
  double value_at(std::uint64_t corner) const;
  void cut_cubes();
  void cut(const Lattice& cube, const std::array<unsigned, 4>& corners, bool mirrored,
           const std::array<double, 8>& values);
  TriangleMesh place_vertices() const;
  Point vertex_on(std::uint64_t edge) const;
  bool inside(const Lattice& at) const;

  std::function<double(const Point&)> value_;
  const Progress& progress_;
  const char* stage_;
  double cell_ = 0;
  Point origin_ = Point::Zero();
  int levels_ = 0;
  std::vector<std::uint64_t> cubes_, corners_;
  std::vector<double> values_;  // at the corners
  std::vector<std::array<std::uint64_t, 3>> triangles_;
};

}  // namespace orchard::detail
