#pragma once
#include <vtkColorTransferFunction.h>

#include <optional>

#include "actors.h"
#include "figure.h"
#include "view_parts.h"

namespace orchard::detail {

// The colours of an array's values, the same ones in all panels.
struct Coloring {
  std::string array, title;
  bool categories = false;  // numbers of things, each with a colour of its own
  std::array<double, 2> range{0, 1};
  vtkSmartPointer<vtkColorTransferFunction> colors;  // of those that are no categories

  Color color_of(double value) const;
};

// Nothing if none is asked for. Throws std::runtime_error, which names the arrays that there are, if no part has the
// one that is.
std::optional<Coloring> coloring_of(const ViewParts& parts, const FigureOptions& figure);

// Whether the points or cells of this have the array.
bool has_colors(const Coloring& coloring, vtkPolyData* data);
// An actor of make_actor(data, ..) in these colours.
void apply(const Coloring& coloring, vtkPolyData* data, vtkActor* actor);
// The points' `color`, for make_spheres(). Precondition: the points have the array.
void color_points(const Coloring& coloring, vtkPolyData* data);

// Multiples of 1, 2, 2.5 or 5 times a power of ten in [low, high], about five of them. Precondition: low < high.
std::vector<double> round_numbers(double low, double high);
// A bar of the colours with the name of the array and values beside it, in a picture of so many pixels.
vtkSmartPointer<vtkRenderer> color_bar(const Coloring& coloring, int width, int height);

}  // namespace orchard::detail
