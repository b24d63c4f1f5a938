#pragma once
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// A frame in which a box has about size one, and points lie on a lattice. A search is chaotic: the last digit of a
// coordinate decides which tree it finds, and a mesh that is moved or scaled has other last digits. On the lattice, it
// has the same numbers, unless a corner is so near to the border between two lattice points that its last digits
// decide. The distance of lattice points is no rational part of the box. So corners that divide the box evenly, or that
// have few digits, are never on such a border.
class CanonicalFrame {
 public:
  // `lattice` is the distance of lattice points if the box is scaled to reach from -1 to 1; 0 means no lattice.
  CanonicalFrame(const Box& box, double lattice);

  Point in(const Point& point) const;
  TriangleMesh in(const TriangleMesh& mesh) const;
  Refinement in(const Refinement& refinement) const;
  // Returns a ball that contains everything in the frame that the given ball contains, despite the shifts by the
  // lattice and by rounding.
  Sphere out(const Sphere& ball) const;

 private:
  Point center_;
  double scale_ = 1;  // in mesh units
  double lattice_;
};

// Rounds points in the frame to a lattice that is unrelated to that of the corners, because evenly spaced points of
// edges lie halfway between that one's points. Relaxed points are known less exactly, so they need a coarse lattice.
Point on_fine_lattice(const Point& point);
Point on_coarse_lattice(const Point& point);

// A surface in its frame. Everything that decides which tree is built runs there. The spheres of the result are then
// enlarged by as much as the lattice moves points, so that they contain the given surface.
class FramedSurface {
 public:
  explicit FramedSurface(const Surface& given);  // keeps a reference

  const Surface& surface() const { return surface_; }
  Refinement in(const Refinement& refinement) const { return frame_.in(refinement); }
  // Moves points into the frame, at the same places of their triangles. Precondition: validate(sampling, given).
  SurfaceSampling in(SurfaceSampling sampling) const;
  SurfaceSampling out(SurfaceSampling sampling) const;
  // Moves the tree out of the frame. Its measured values are reset.
  void take_out(SphereTree& tree) const;

 private:
  const Surface& given_;
  CanonicalFrame frame_;
  Surface surface_;
};

}  // namespace orchard::detail
