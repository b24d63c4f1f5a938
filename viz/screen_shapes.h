#pragma once
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include <Eigen/Core>

#include "palette.h"

// Shapes on the picture, in pixels of its panel, in front of everything.
namespace orchard::detail {

// `width` is that of lines, in pixels.
void add_screen_shape(vtkRenderer* renderer, vtkPolyData* shape, const Color& color, double width);
void add_screen_line(vtkRenderer* renderer, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Color& color,
                     double width);

}  // namespace orchard::detail
