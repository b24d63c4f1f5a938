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

// The contents of a scene of view.h, for its pictures and its window.
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

// Returns no parts if the blocks are not those of a scene.
ViewParts view_parts(const Blocks& blocks);

// Returns a length of the order of the model's size, and everything that has to be in view.
double size_of(const ViewParts& parts);
std::vector<Extent> extents_of(const ViewParts& parts);
// Also returns the room that the figure asks for.
std::vector<Extent> extents_of(const ViewParts& parts, const FigureOptions& figure);

// Whether the data has only points, and whether these have radii, so that they are spheres.
bool is_point_set(vtkPolyData* data);
bool is_sphere_set(vtkPolyData* data);
// Whether the data are the cubes of a simulation, which bound the motion of its bodies.
bool is_bound(vtkPolyData* data);

// Returns the smallest and the largest radius of all axes, because axes next to each other share one range.
std::array<double, 2> radii_of_axes(const ViewParts& parts);

struct Coloring;

// How the parts of a scene are drawn.
struct PartLook {
  double size = 1, line_width = 1;
  double opacity = 0.16;                               // of meshes next to other things
  std::optional<std::array<double, 3>> backward = {};  // Voronoi cells are cut open towards it
  bool edges = false;  // draw borders and seams of axes, and feature edges of .vtp files
  bool balls = false;  // the balls of axes
  const ColorMap* map = &kViridis;
  std::array<double, 2> radii{0, 1};   // at the ends of the map, for axes that are coloured by radius
  const Coloring* coloring = nullptr;  // null for a colour of its own for each part
};

// Adds what is the same for every level. Returns the actors of the faces of meshes next to other things, so that their
// opacity can be changed.
std::vector<vtkSmartPointer<vtkActor>> add_still_parts(vtkRenderer* renderer, const ViewParts& parts,
                                                       const PartLook& look);
// Draws the spheres of a level, coloured by branch if there is one tree, and otherwise by tree.
std::vector<vtkSmartPointer<vtkActor>> level_actors(const NamedParts<Data>& trees, const Coloring* coloring = nullptr);

// Return "lamp.obj, lamp.orchard, level 2", and the values of what is seen. A negative level means none.
std::string caption_of(const ViewParts& parts, int level);
std::string detail_of(const ViewParts& parts, int level);

}  // namespace orchard::detail
