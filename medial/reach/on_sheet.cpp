#include "on_sheet.h"

namespace orchard::detail {
namespace {

// A part of the distance between the middle of the triangle and its edge. A ball that is nearer to the middle than this
// does not belong to the edge.
constexpr double kOnSheet = 0.5;

}  // namespace

bool lies_on_sheet(const Surface& surface, const Reconstruction& axis, const Point& p, const Point& q,
                   const Point& vertex) {
  const Point middle = (p + q + vertex) / 3;
  Sphere touching{Point::Zero(), 0};
  axis.distance(surface.closest(middle).position, touching);
  const Vector along = q - p;
  const double height = along.cross(vertex - p).norm() / along.norm();
  return (touching.center - middle).norm() < kOnSheet * height / 3;
}

}  // namespace orchard::detail
