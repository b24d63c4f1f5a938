#include "axis_of_balls.h"

#include <algorithm>

#include "../axis/incidence.h"
#include "../axis/point_normals.h"
#include "orchard/geometry/angle.h"
#include "orchard/geometry/sampling.h"

namespace orchard::detail {
namespace {

// Adds the contacts of a ball, and returns the largest angle at which two of them are seen.
double add_contacts(const ExactBall& ball, SurfaceSampling& contacts) {
  double widest = 0;
  const auto touching = ball.touching();
  for (std::size_t i = 0; i < touching.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double angle = angle_between(touching[i].position - ball.center, touching[k].position - ball.center);
      widest = std::max(widest, angle);
    }
    contacts.points.push_back(touching[i].position);
    contacts.triangles.push_back(touching[i].triangle);
    contacts.features.push_back(touching[i].feature);
    contacts.origins.push_back(touching[i].feature == Feature::face ? PointOrigin::face : PointOrigin::edge);
  }
  return widest;
}

// Returns the two contacts, of one corner of a triangle, that are seen farthest apart from its middle.
std::array<Index, 2> points_of_triangle(const MedialAxis& axis, const std::array<Index, 3>& corners) {
  const Point middle = (axis.centers[corners[0]] + axis.centers[corners[1]] + axis.centers[corners[2]]) / 3;
  std::array<Index, 2> best{axis.forming_points[corners[0]][0], axis.forming_points[corners[1]][0]};
  double widest = -1;
  for (const Index v : corners) {
    const auto points = axis.forming_points[v];
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const double angle = angle_between(axis.points[points[i]] - middle, axis.points[points[k]] - middle);
        if (angle <= widest) continue;
        widest = angle;
        best = {points[k], points[i]};
      }
    }
  }
  return best;
}

}  // namespace

MedialAxis axis_of_balls(const Surface& surface, const BallComplex& complex) {
  MedialAxis axis;
  SurfaceSampling contacts;
  for (const ExactBall& ball : complex.balls) {
    axis.centers.push_back(ball.center);
    axis.radii.push_back(ball.radius);
    const Index first = contacts.size();
    axis.angles.push_back(add_contacts(ball, contacts));
    for (Index contact = first; contact < contacts.size(); ++contact) axis.forming_points.items.push_back(contact);
    axis.forming_points.close_row();
  }
  add_points(surface, contacts, axis);
  std::vector<std::array<Index, 2>> adjacent;
  for (const auto& [a, b] : complex.edges) {
    adjacent.push_back({a, b});
    adjacent.push_back({b, a});
  }
  axis.neighbors = rows_of(adjacent, axis.size());
  for (const auto& corners : complex.triangles) {
    axis.faces.items.insert(axis.faces.items.end(), corners.begin(), corners.end());
    axis.faces.close_row();
    axis.face_points.push_back(points_of_triangle(axis, corners));
  }
  return axis;
}

}  // namespace orchard::detail
