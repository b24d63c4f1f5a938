#include "camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace orchard::detail {
namespace {

using Eigen::Vector3d;

constexpr double kMargin = 1.06;  // the size of the view over that of the model

// Returns the length of a pixel.
double unit_of(const View& view, int width, int height, int caption_height) {
  return kMargin * std::max(view.height / (height - caption_height), view.width / width);
}

}  // namespace

View looking(const Direction& request) {
  const int axis = request.up - 'x';
  const Vector3d up = Vector3d::Unit(axis);
  // If z is up, the front is -y, as in CAD; if y is up, the front is z.
  const Vector3d front = axis == 2 ? Vector3d(-Vector3d::UnitY()) : Vector3d(Vector3d::Unit((axis + 1) % 3));
  const Vector3d side = up.cross(front);
  constexpr double kDegree = std::numbers::pi / 180;
  const double azimuth = request.azimuth * kDegree, elevation = request.elevation * kDegree;
  View view;
  view.backward =
      std::cos(elevation) * (std::cos(azimuth) * front + std::sin(azimuth) * side) + std::sin(elevation) * up;
  view.right = up.cross(view.backward).normalized();
  view.up = view.backward.cross(view.right);
  return view;
}

View make_view(const Direction& request, const std::vector<Extent>& extents) {
  View view = looking(request);
  Eigen::AlignedBox3d box;
  for (const Extent& extent : extents) {
    const Vector3d center(extent.center.data());
    const Vector3d seen(center.dot(view.right), center.dot(view.up), center.dot(view.backward));
    box.extend(seen - Vector3d::Constant(extent.radius));
    box.extend(seen + Vector3d::Constant(extent.radius));
  }
  if (box.isEmpty() || !(box.sizes().norm() > 0)) throw std::runtime_error("the files contain nothing to draw");
  const Vector3d middle = box.center();
  view.center = middle.x() * view.right + middle.y() * view.up + middle.z() * view.backward;
  view.width = std::max(box.sizes().x(), 0.01 * box.sizes().norm());
  view.height = std::max(box.sizes().y(), 0.01 * box.sizes().norm());
  view.depth = 0.5 * box.sizes().norm();
  return view;
}

View look_at(View view, const Vector3d& center, double span) {
  view.center = center;
  view.width = view.height = span;
  return view;
}

View steady(View view, const std::vector<Extent>& extents) {
  Eigen::AlignedBox3d box;
  for (const Extent& extent : extents) box.extend(Vector3d(extent.center.data()));
  view.center = box.center();
  double radius = 0;
  for (const Extent& extent : extents)
    radius = std::max(radius, (Vector3d(extent.center.data()) - view.center).norm() + extent.radius);
  view.width = view.height = 2 * radius;
  view.depth = radius;
  return view;
}

Eigen::Vector3d Projection::operator()(const Vector3d& place) const {
  const Vector3d from = (place - center) / unit;
  return {middle.x() + from.dot(right), middle.y() + from.dot(up), from.dot(backward)};
}

Projection projection_of(const View& view, int width, int height, int caption_height) {
  return {view.right,
          view.up,
          view.backward,
          view.center,
          unit_of(view, width, height, caption_height),
          Eigen::Vector2d(0.5 * width, 0.5 * (height + caption_height))};
}

void aim(vtkCamera* camera, const View& view, int width, int height, int caption_height) {
  const double unit = unit_of(view, width, height, caption_height);
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * unit * height);
  const Vector3d focus = view.center - 0.5 * unit * caption_height * view.up;
  const Vector3d eye = focus + 3 * view.depth * view.backward;
  camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(view.up.x(), view.up.y(), view.up.z());
  camera->SetClippingRange(1.5 * view.depth, 4.5 * view.depth);
}

}  // namespace orchard::detail
