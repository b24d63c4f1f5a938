#pragma once
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// A frame in which a box has about size one, and points lie on a lattice. A search is chaotic: the last digit of a
// coordinate decides which tree comes out, and a mesh that is moved or scaled has other last digits. On the lattice it
// has the same numbers, unless a corner is as near to the border between two lattice points as its digits reach. No
// distance on the lattice is a rational part of the box: corners that divide it evenly, or that have few digits, are
// never on such a border.
class CanonicalFrame {
 public:
  // lattice: how far apart its points are, where the box reaches from -1 to 1; 0: there is none.
  CanonicalFrame(const Box& box, double lattice);

  Point in(const Point& point) const;
  TriangleMesh in(const TriangleMesh& mesh) const;
  Refinement in(const Refinement& refinement) const;
  // A ball that holds all that the ball holds of what is in the frame, wherever the lattice and roundings moved it.
  Sphere out(const Sphere& ball) const;

 private:
  Point center_;
  double scale_ = 1;  // mesh units
  double lattice_;
};

// The same for points in the frame, on lattices that have nothing to do with that of the corners, since evenly spaced
// points of edges lie half way between its points. Points that were relaxed are known less exactly: to them belongs a
// coarse one.
Point on_fine_lattice(const Point& point);
Point on_coarse_lattice(const Point& point);

// A surface as it is in its frame. What decides which tree is built runs there; what comes out is grown by as much as
// the lattice moves points, so that it holds the given surface.
class FramedSurface {
 public:
  explicit FramedSurface(const Surface& given);  // keeps a reference

  const Surface& surface() const { return surface_; }
  Refinement in(const Refinement& refinement) const { return frame_.in(refinement); }
  // Points stay where they are on their triangles. Precondition: validate(sampling, given).
  SurfaceSampling in(SurfaceSampling sampling) const;
  SurfaceSampling out(SurfaceSampling sampling) const;
  // What was measured is forgotten.
  void take_out(SphereTree& tree) const;

 private:
  const Surface& given_;
  CanonicalFrame frame_;
  Surface surface_;
};

}  // namespace orchard::detail
