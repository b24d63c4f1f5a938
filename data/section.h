// Flat outlines and the frames that place them in space.
#pragma once

#include <vector>

#include "vec3.h"

namespace orchard::models {

/// A simple polygon in its own plane, counter-clockwise.
using Section = std::vector<Vec2>;

/// Regular n-gon with its corners on the circle; the middle of side 0 is at angle `phase`.
[[nodiscard]] Section regular_polygon(int sides, double radius, double phase = 0.0);

/// Polygon whose side i touches the circle of the given radius at angle degrees[i] (increasing).
/// Used where a round part needs flat sides at chosen angles.
[[nodiscard]] Section tangent_polygon(const std::vector<double>& degrees, double radius);

/// Two half circles, `reach` left and right of the centre, joined by straight sides of several
/// pieces. Two of them that differ in radius only have parallel sides.
[[nodiscard]] Section stadium(double reach, double radius, int steps, int pieces);

[[nodiscard]] Section scaled(const Section& section, double factor);
[[nodiscard]] Section shifted(const Section& section, Vec2 offset);

/// A plane with axes: sections are drawn in (x, y), parts grow along normal().
struct Frame {
  Vec3 origin;
  Vec3 x;
  Vec3 y;

  [[nodiscard]] Vec3 normal() const { return cross(x, y); }
  [[nodiscard]] Vec3 at(Vec2 p) const { return origin + x * p.x + y * p.y; }

  /// The same axes, moved along the normal.
  [[nodiscard]] Frame ahead(double distance) const { return {origin + normal() * distance, x, y}; }
  [[nodiscard]] Frame moved(Vec3 offset) const { return {origin + offset, x, y}; }

  /// Turned about the line through `pivot` along the unit vector `axis`. When that line lies in
  /// the plane of the frame, a section and its turned copy are joined by planar quadrilaterals.
  [[nodiscard]] Frame turned(Vec3 pivot, Vec3 axis, double angle) const;
};

/// Frame at `origin` growing along the unit vector `normal`; its x axis is the part of `hint`
/// perpendicular to the normal.
[[nodiscard]] Frame frame_along(Vec3 origin, Vec3 normal, Vec3 hint);

}  // namespace orchard::models
