#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/refinement.h"

namespace orchard::detail {

// A frame in which a mesh has about size one and its corners lie on a lattice. A search is chaotic: the last digit of a
// coordinate decides which tree comes out, and a mesh that is moved or scaled has other last digits. On the lattice it
// has the same numbers, unless a corner is as near to the border between two lattice points as its digits reach, so the
// same search is made. What comes out is grown by as much as the lattice moves points.
class CanonicalFrame {
 public:
  explicit CanonicalFrame(const Box& box);
  // The same without the lattice, for meshes that lose their inside on it.
  static CanonicalFrame without_lattice(const Box& box);

  Point in(const Point& point) const { return snapped(point, kLattice); }
  // For what is known less exactly, as points are that were relaxed: a coarser lattice.
  Point roughly_in(const Point& point) const { return snapped(point, kCoarseLattice); }
  // What is in the frame already, on the lattice.
  static Point on_lattice(const Point& point) { return kLattice * (point / kLattice).array().round().matrix(); }
  TriangleMesh in(const TriangleMesh& mesh) const;
  Refinement in(const Refinement& refinement) const;
  // A ball that holds all that the ball holds, and what the lattice drew into it.
  Sphere in(const Sphere& ball) const;
  Sphere out(const Sphere& ball) const;

 private:
  static constexpr double kLattice = 0x1p-22, kCoarseLattice = 0x1p-10;
  // How far the lattice moves a point: half the diagonal of a cell, and roundings.
  static constexpr double kMoved = 0.9 * kLattice;
  Point snapped(const Point& point, double lattice) const;

  Point center_;
  double scale_ = 1;  // mesh units
  bool snaps_ = true;
};

}  // namespace orchard::detail
