#pragma once
#include <vtkUnstructuredGrid.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actors.h"
#include "blocks.h"

// What a scene of view.h holds, as its pictures and its window need it.
namespace orchard::detail {

template <class Value>
using NamedParts = std::vector<std::pair<std::string, Value>>;

struct ViewParts {
  NamedParts<Data> meshes, axes, points;
  NamedParts<Data> data;  // .vtp files
  NamedParts<vtkSmartPointer<vtkUnstructuredGrid>> cells;
  std::map<int, NamedParts<Data>> levels;  // of all trees, by number

  bool any() const { return !(meshes.empty() && meshes_alone()); }
  bool meshes_alone() const {
    return axes.empty() && points.empty() && data.empty() && cells.empty() && levels.empty();
  }
};

// Empty where the blocks are not those of a scene.
ViewParts view_parts(const Blocks& blocks);

// A length of the model's order, and everything that the camera must keep in view.
double size_of(const ViewParts& parts);
std::vector<Extent> extents_of(const ViewParts& parts);
// The same, and the room that the figure asks for.
std::vector<Extent> extents_of(const ViewParts& parts, const FigureOptions& figure);

// Whether data has points alone; whether these have radii, so that they are spheres.
bool is_point_set(vtkPolyData* data);
bool is_sphere_set(vtkPolyData* data);
// Whether these are the cubes of a simulation, which bound the motion of the bodies in them.
bool is_bound(vtkPolyData* data);

// The smallest and the largest radius of all axes: one range for those beside each other.
std::array<double, 2> radii_of_axes(const ViewParts& parts);

struct Coloring;

// How the parts are drawn.
struct PartLook {
  double size = 1, line_width = 1;
  double opacity = 0.16;                               // of meshes beside other things
  std::optional<std::array<double, 3>> backward = {};  // cells are cut open towards it
  bool edges = false;                                  // borders and seams of axes, feature edges of .vtp files
  bool balls = false;                                  // the balls of axes
  const ColorMap* map = &kViridis;
  std::array<double, 2> radii{0, 1};   // at the ends of the map, where axes have their own colours
  const Coloring* coloring = nullptr;  // null: each thing in its own colours
};

// What is seen whatever the level. Of meshes beside other things the faces' actors come back, for their opacity.
std::vector<vtkSmartPointer<vtkActor>> add_still_parts(vtkRenderer* renderer, const ViewParts& parts,
                                                       const PartLook& look);
// The spheres of a level: one tree's by branch, several trees' by tree.
std::vector<vtkSmartPointer<vtkActor>> level_actors(const NamedParts<Data>& trees, const Coloring* coloring = nullptr);

// "lamp.obj, lamp.orchard, level 2", and the figures of what is seen. level < 0: there is none.
std::string caption_of(const ViewParts& parts, int level);
std::string detail_of(const ViewParts& parts, int level);

}  // namespace orchard::detail
