#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

// The surface where a function is zero, as a closed manifold mesh that faces where it is positive.
//
// The signs at the corners of a grid decide, whose cubes are halved where the function may be zero. Each of the
// smallest cubes is cut into six tetrahedra, which fit together; the part of the surface in each is one triangle or
// two, with corners on its edges. So the mesh is closed, manifold and without self-intersections for every function.
// - Parts thinner than a cell may be lost, and edges are cut off by less than a cell.
// - No place of the mesh has a value farther from 0 than a cell: it is no farther than that from a corner of its
//   triangle, whose value is 0 up to rounding.
// - A place with a value beyond sqrt(3) cells, the diameter of a cube, is on the side of the mesh that its sign says.
class LevelSet {
 public:
  // `value`: 1-Lipschitz, and safe to call from many threads; above 0 outside `box`. `cell`: the edge length of the
  // cubes, below 2^-20 of which the box has no more than.
  LevelSet(std::function<double(const Point&)> value, const Box& box, double cell, const Progress& progress,
           const char* stage);

  // No triangles if no corner of the grid is inside. Parallel; the same result for any number of threads.
  TriangleMesh mesh();

  // After mesh(): whether a part of the inside around `place` was lost: the cube there is one that the surface can
  // meet, with no corner inside, nor at its neighbours. Precondition: `place` is in the box.
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
