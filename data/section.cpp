#include "section.h"

#include <cmath>
#include <cstddef>

namespace orchard::models {

namespace {

Vec3 rotated(Vec3 v, Vec3 axis, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1.0 - c));
}

}  // namespace

Section regular_polygon(int sides, double radius, double phase) {
  Section section;
  const double step = 2.0 * kPi / sides;
  for (int i = 0; i < sides; ++i) {
    const double angle = phase + (i - 0.5) * step;
    section.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return section;
}

Section tangent_polygon(const std::vector<double>& degrees, double radius) {
  Section section;
  for (std::size_t i = 0; i < degrees.size(); ++i) {
    // Corner i lies between sides i - 1 and i, so that side i starts at corner i.
    const double before = i == 0 ? degrees.back() - 360.0 : degrees[i - 1];
    const double middle = radians(0.5 * (before + degrees[i]));
    const double half_gap = radians(0.5 * (degrees[i] - before));
    const double reach = radius / std::cos(half_gap);
    section.push_back({reach * std::cos(middle), reach * std::sin(middle)});
  }
  return section;
}

Section stadium(double reach, double radius, int steps, int pieces) {
  Section section;
  for (const double side : {1.0, -1.0}) {
    for (int i = 0; i <= steps; ++i) {
      const double angle = kPi * (static_cast<double>(i) / steps - 0.5);
      section.push_back({side * (reach + radius * std::cos(angle)), side * radius * std::sin(angle)});
    }
    for (int i = 1; i < pieces; ++i) {
      section.push_back({side * reach * (1.0 - 2.0 * i / pieces), side * radius});
    }
  }
  return section;
}

Section scaled(const Section& section, double factor) {
  Section result = section;
  for (Vec2& p : result) p = p * factor;
  return result;
}

Section shifted(const Section& section, Vec2 offset) {
  Section result = section;
  for (Vec2& p : result) p = p + offset;
  return result;
}

Frame Frame::turned(Vec3 pivot, Vec3 axis, double angle) const {
  return {pivot + rotated(origin - pivot, axis, angle), rotated(x, axis, angle), rotated(y, axis, angle)};
}

Frame frame_along(Vec3 origin, Vec3 normal, Vec3 hint) {
  const Vec3 x = normalized(hint - normal * dot(hint, normal));
  return {origin, x, cross(normal, x)};
}

}  // namespace orchard::models
