#pragma once
#include <vtkActor.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataSetAttributes.h>
#include <vtkMapper.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "palette.h"
#include "panels.h"

// The shared look of everything that the panels show.
namespace orchard::detail {

using Data = vtkSmartPointer<vtkPolyData>;

inline constexpr Color kInk{0.13, 0.16, 0.20};
inline constexpr Color kStone{0.73, 0.77, 0.82};
inline constexpr Color kGlass{0.72, 0.78, 0.85};  // of a mesh that is drawn transparently
inline constexpr double kFeatureAngle = 40;       // degrees
// Consecutive colours differ, also in brightness, because adjacent branches get them.
inline constexpr std::array<Color, 8> kBranchColors{rgb(0x4e79a7), rgb(0xf2a13c), rgb(0x6aaa5a), rgb(0xe0605f),
                                                    rgb(0x7cc0bb), rgb(0xf0d060), rgb(0xb083b0), rgb(0xe8a0b4)};
inline constexpr std::array<Color, 3> kOriginColors{rgb(0x2f6db3), rgb(0xe8871e), rgb(0xc8233c)};

// Returns an array with a value for each point or cell. Throws std::runtime_error if there is none, because orchard
// writes no such file.
vtkDataArray* require_array(vtkDataSetAttributes* data, const char* name, vtkIdType count);

// Returns 12345 as "12 345"; the other function adds what is counted: "1 sphere", "2 spheres".
std::string grouped(vtkIdType number);
std::string counted(vtkIdType number, const std::string& thing);
// Returns "64 spheres, mean inaccuracy 0.085 R"; without the inaccuracy if it was not measured.
std::string level_figures(vtkPolyData* spheres, double bounding_radius);

vtkSmartPointer<vtkActor> make_actor(vtkMapper* mapper, const Color& color, double opacity = 1);
vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data, const Color& color, double opacity = 1);
// Draws boundary edges, and edges at which the surface turns by more than `angle` degrees; all edges if it is 0.
vtkSmartPointer<vtkActor> edges(vtkPolyData* mesh, double angle, double width, double opacity = 1);
// Draws a sphere of its `radius` around each point, in the points' `color`. The spheres have enough facets to look
// round.
vtkSmartPointer<vtkActor> make_spheres(vtkPolyData* points);
// Draws a dot on each point, so large that gaps remain between evenly spread points. `color` as above.
vtkSmartPointer<vtkActor> make_dots(vtkPolyData* points, double size);
// Draws sheets of a medial axis, coloured by the point array `name` along `colors`, whose range is that of the array.
vtkSmartPointer<vtkActor> make_sheet(vtkPolyData* data, const char* name, vtkColorTransferFunction* colors);

vtkSmartPointer<vtkRenderer> make_renderer(double size);
// Adds a mesh on its own: faces, edges, and the outlines of its triangles if there are not too many.
void add_mesh(vtkRenderer* renderer, vtkPolyData* mesh, double line_width);
// Adds a transparent mesh around other things. Returns the actor of its faces.
vtkSmartPointer<vtkActor> add_glass(vtkRenderer* renderer, vtkPolyData* mesh, double line_width, double opacity = 0.16);
// Draws the spheres of a level of a tree, coloured by branch.
vtkSmartPointer<vtkActor> make_level(vtkPolyData* spheres);

vtkSmartPointer<vtkColorTransferFunction> transfer_function(const ColorMap& map, const double range[2]);
// Returns colours that are pale for 0 and red for `max`.
vtkSmartPointer<vtkColorTransferFunction> error_colors(double max);

void extend(std::vector<Extent>& extents, vtkPolyData* data, const char* radius_array);

// Sets the colour of each tuple of `data`, given a function of the tuple's number.
template <typename ColorOf>
void set_colors(vtkDataSetAttributes* data, vtkIdType count, const ColorOf& color_of) {
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("color");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const Color color = color_of(i);
    for (int c = 0; c < 3; ++c) {
      colors->SetTypedComponent(i, c,
                                static_cast<unsigned char>(std::lround(255 * color[static_cast<std::size_t>(c)])));
    }
  }
  data->AddArray(colors);
}

}  // namespace orchard::detail
