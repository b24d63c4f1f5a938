#pragma once
#include <vtkCamera.h>

#include <Eigen/Geometry>
#include <vector>

#include "panels.h"

// From where a model is seen.
namespace orchard::detail {

struct Direction {
  char up = 'y';
  double azimuth = 35, elevation = 23;  // degrees
};

struct View {
  Eigen::Vector3d right, up, backward;  // the picture's axes; backward: towards the eye
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double width = 1, height = 1;  // of what must be seen
  double depth = 1;              // half of it
};

// Which way the axes point, without a centre and a size.
View looking(const Direction& direction);
// Everything in view. Throws std::runtime_error if there is nothing.
View make_view(const Direction& direction, const std::vector<Extent>& extents);

// The same direction, at a part of what there is: `span` wide and high.
View look_at(View view, const Eigen::Vector3d& center, double span);
// The same direction, with room for everything from all directions: for pictures that are shown one after the other.
View steady(View view, const std::vector<Extent>& extents);

// Places in a picture: x to the right and y upward in pixels from its lower left corner, z towards the eye.
struct Projection {
  Eigen::Vector3d right, up, backward, center;       // as of a View
  double unit = 1;                                   // the length of a pixel
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // where the centre is

  Eigen::Vector3d operator()(const Eigen::Vector3d& place) const;
};
// That of aim().
Projection projection_of(const View& view, int width, int height, int caption_height);

// The model in a rectangle of pixels, above its lowest `caption_height`.
void aim(vtkCamera* camera, const View& view, int width, int height, int caption_height);

}  // namespace orchard::detail
