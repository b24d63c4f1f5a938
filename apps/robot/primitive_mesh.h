#pragma once
#include "robot/robot.h"

namespace orchard::robot {

struct PrimitiveMesh {
  TriangleMesh mesh;     // around the element's own origin; the shape lies in it
  double deviation = 0;  // no point of its surface is farther than this from the shape, in metres; 0: it is the shape
};

// A box as it is; a cylinder, sphere or capsule as a polyhedron around it, whose facets touch it: deviations are 0.5 %
// of the radius or less. Precondition: the element is no mesh.
PrimitiveMesh primitive_mesh(const Element& element);

}  // namespace orchard::robot
