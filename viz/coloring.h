#pragma once
#include <vtkColorTransferFunction.h>

#include <optional>

#include "actors.h"
#include "figure.h"
#include "view_parts.h"

namespace orchard::detail {

// The colours of the values of an array, the same in all panels.
struct Coloring {
  std::string array, title;
  bool categories = false;  // the values are numbers of parts, each with a colour of its own
  std::array<double, 2> range{0, 1};
  vtkSmartPointer<vtkColorTransferFunction> colors;  // unless the values are categories

  Color color_of(double value) const;
};

// Returns nullopt if no colours are asked for. Throws std::runtime_error if no part has the array; the message names
// the arrays that exist.
std::optional<Coloring> coloring_of(const ViewParts& parts, const FigureOptions& figure);

// Whether the points or cells of this have the array.
bool has_colors(const Coloring& coloring, vtkPolyData* data);
// Applies the colours to an actor of make_actor(data, ..).
void apply(const Coloring& coloring, vtkPolyData* data, vtkActor* actor);
// Sets the points' `color` for make_spheres(). Precondition: the points have the array.
void color_points(const Coloring& coloring, vtkPolyData* data);

// Returns about five multiples of 1, 2, 2.5 or 5 times a power of ten in [low, high]. Precondition: low < high.
std::vector<double> round_numbers(double low, double high);
// Draws a bar of the colours, with the name of the array and values next to it, in a picture of this size in pixels.
vtkSmartPointer<vtkRenderer> color_bar(const Coloring& coloring, int width, int height);

}  // namespace orchard::detail
