#pragma once
#include <array>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// The parts of a surface that lie inside the solid, because the surface cuts itself or parts of it share faces. The
// signed distance is 0 there, as on the boundary of the solid, so a branch and bound that looks for places outside
// would divide its cells along all of such a part down to the finest ones. Near most of its places, such a part is a
// piece of one plane, or of two that cross. There, this class proves that nothing is outside.
class InteriorSurface {
 public:
  explicit InteriorSurface(const Surface& surface);

  // True means that no point of the closed ball is farther from the solid than depth(); false means that this is not
  // known. It costs as much as a query of the distance if the surface near the ball is not in one or two planes. Throws
  // InputError unless surface.solid().
  bool fill(const Sphere& ball) const;
  double depth() const { return depth_; }  // mesh units

 private:
  struct Plane {
    Vector normal;
    double offset;  // the offset of the plane along the normal
    double distance(const Point& at) const { return normal.dot(at) - offset; }
  };
  struct Planes {
    std::array<Plane, 2> planes;
    std::size_t count = 0;  // 0 if there are none near, or if the surface near the ball is not in one or two planes
  };
  Planes planes_near(const Sphere& ball) const;
  bool in_slab(const Plane& plane, Index triangle) const;
  bool is_inside_beyond(const Plane& plane, const Sphere& ball) const;
  bool is_inside_beyond(const std::array<Plane, 2>& planes, const Sphere& ball) const;
  bool is_inside(const Point& at) const { return surface_.winding_number(at) > 0; }

  const Surface& surface_;
  double thickness_, depth_;
};

}  // namespace orchard::detail
