#pragma once
#include <vtkCamera.h>

#include <Eigen/Geometry>
#include <vector>

#include "panels.h"

// The direction from which a model is seen, and the part of it that is seen.
namespace orchard::detail {

struct Direction {
  char up = 'y';
  double azimuth = 35, elevation = 23;  // degrees
};

struct View {
  Eigen::Vector3d right, up, backward;  // the axes of the picture; `backward` points towards the eye
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double width = 1, height = 1;  // of what has to be in view
  double depth = 1;              // half of its depth
};

// Returns the axes of a view, without centre and size.
View looking(const Direction& direction);
// Returns a view of everything. Throws std::runtime_error if there is nothing.
View make_view(const Direction& direction, const std::vector<Extent>& extents);

// Returns a view in the same direction that is `span` wide and high.
View look_at(View view, const Eigen::Vector3d& center, double span);
// Returns a view in the same direction that has room for everything seen from any direction, for pictures that are
// shown one after another.
View steady(View view, const std::vector<Extent>& extents);

// Maps places to a picture: x to the right and y upward, in pixels from the lower left corner, and z towards the eye.
struct Projection {
  Eigen::Vector3d right, up, backward, center;       // those of the View
  double unit = 1;                                   // the length of a pixel
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // the position of the centre in the picture

  Eigen::Vector3d operator()(const Eigen::Vector3d& place) const;
};
// Returns the projection that aim() sets up.
Projection projection_of(const View& view, int width, int height, int caption_height);

// Aims a camera so that the model fills a rectangle of pixels above the lowest `caption_height`.
void aim(vtkCamera* camera, const View& view, int width, int height, int caption_height);

}  // namespace orchard::detail
