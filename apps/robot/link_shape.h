#pragma once
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "robot/dae_mesh.h"
#include "robot/robot.h"
#include "robot/urdf_reader.h"

namespace orchard::robot {

struct ShapeOptions {
  Geometry geometry = Geometry::collision;
  DaeOptions dae{};
  bool wrap = true;              // wrap elements that are open even after repair; otherwise they stay open
  std::optional<double> join{};  // as RepairMeshOptions::join_distance
};

// A link's shape in its own frame: the union of its elements.
struct LinkShape {
  Index link = 0;         // of the robot
  TriangleMesh original;  // the elements' triangles as they are read, moved into the link's frame
  // The same with each element repaired or wrapped as needed. A solid, unless an element is open and is not to be
  // wrapped. Where elements overlap, parts of the surface lie inside.
  Surface surface;
  bool repaired = false, wrapped = false;  // some element
  // How far the polyhedra that stand for curved primitives stick out of them, in metres; the primitives lie in them.
  double deviation = 0;
  std::vector<std::string> notes;  // a line for each thing that was done to an element or is wrong with it
};

// The triangles of one element in its link's frame as they are read: x' = origin (scale x), turned where the scale
// mirrors. Throws InputError as reading meshes does.
TriangleMesh element_mesh(const Element& element, const DaeOptions& dae);

// The shape of a link; nothing where it has no element that counts. Elements are repaired one by one in the frames of
// their files, as repair_mesh() does; one that is no solid after that is wrapped, if options say so, about 0.2 % of its
// diagonal outside. Deterministic. Throws InputError as reading meshes does.
std::optional<LinkShape> link_shape(const Robot& robot, Index link, const ShapeOptions& options = {});

// Those of all links that have elements, in the order of the links; on several threads.
std::vector<LinkShape> link_shapes(const Robot& robot, const ShapeOptions& options = {}, const Progress& progress = {});

}  // namespace orchard::robot
