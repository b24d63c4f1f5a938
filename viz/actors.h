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

// What the panels are put together from: one look for all of them.
namespace orchard::detail {

using Data = vtkSmartPointer<vtkPolyData>;

inline constexpr Color kInk{0.13, 0.16, 0.20};
inline constexpr Color kStone{0.73, 0.77, 0.82};
inline constexpr Color kGlass{0.72, 0.78, 0.85};  // of a mesh that one looks through
inline constexpr double kFeatureAngle = 40;       // degrees
// Neighbouring branches must differ, also in brightness.
inline constexpr std::array<Color, 8> kBranchColors{rgb(0x4e79a7), rgb(0xf2a13c), rgb(0x6aaa5a), rgb(0xe0605f),
                                                    rgb(0x7cc0bb), rgb(0xf0d060), rgb(0xb083b0), rgb(0xe8a0b4)};
inline constexpr std::array<Color, 3> kOriginColors{rgb(0x2f6db3), rgb(0xe8871e), rgb(0xc8233c)};

// Values one per point or cell; throws std::runtime_error if there are none: such a file is not one of ours.
vtkDataArray* require_array(vtkDataSetAttributes* data, const char* name, vtkIdType count);

// 12345 as "12 345"; and with what is counted, "1 sphere", "2 spheres".
std::string grouped(vtkIdType number);
std::string counted(vtkIdType number, const std::string& thing);
// "64 spheres, mean inaccuracy 0.085 R", the latter where it was measured.
std::string level_figures(vtkPolyData* spheres, double bounding_radius);

vtkSmartPointer<vtkActor> make_actor(vtkMapper* mapper, const Color& color, double opacity = 1);
vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data, const Color& color, double opacity = 1);
// Boundary edges and those where the surface turns by more than `angle` degrees; 0: all.
vtkSmartPointer<vtkActor> edges(vtkPolyData* mesh, double angle, double width, double opacity = 1);
// A sphere of its `radius` around each point, in the points' `color`. Fine enough to look round, within reason.
vtkSmartPointer<vtkActor> make_spheres(vtkPolyData* points);
// A dot on each point, as large as leaves gaps between evenly spread ones; `color` as above.
vtkSmartPointer<vtkActor> make_dots(vtkPolyData* points, double size);
// Coloured by the point array `name` along `colors`, its range that of the array; sheets of a medial axis.
vtkSmartPointer<vtkActor> make_sheet(vtkPolyData* data, const char* name, vtkColorTransferFunction* colors);

vtkSmartPointer<vtkRenderer> make_renderer(double size);
// The mesh by itself: faces, edges, and the outlines of its triangles if they are not too many.
void add_mesh(vtkRenderer* renderer, vtkPolyData* mesh, double line_width);
// The mesh around other things; its faces come back.
vtkSmartPointer<vtkActor> add_glass(vtkRenderer* renderer, vtkPolyData* mesh, double line_width, double opacity = 0.16);
// The spheres of a tree's level, coloured by branch.
vtkSmartPointer<vtkActor> make_level(vtkPolyData* spheres);

vtkSmartPointer<vtkColorTransferFunction> transfer_function(const ColorMap& map, const double range[2]);
// Pale where a value is 0, red where it is `max`.
vtkSmartPointer<vtkColorTransferFunction> error_colors(double max);

void extend(std::vector<Extent>& extents, vtkPolyData* data, const char* radius_array);

// Colours per tuple of `data` from a function of the tuple's number.
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
