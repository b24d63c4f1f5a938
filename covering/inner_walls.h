#pragma once
#include <array>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Inner walls: where a surface cuts itself, or parts of it share faces, some of it lies inside the solid. The signed
// distance is 0 there, as on the border, and a branch and bound that looks for places outside would follow all of a
// wall down to its finest cells. Near most of its places a wall is a piece of one plane, or of two that cross: there
// this class proves that nothing is outside.
class InnerWalls {
 public:
  explicit InnerWalls(const Surface& surface);

  // True: no point of the closed ball is farther from the solid than depth(). False: not known. As fast as a query of
  // the distance where neither one plane nor two hold what is near. Throws InputError unless surface.solid().
  bool fill(const Sphere& ball) const;
  double depth() const { return depth_; }  // mesh units

 private:
  struct Plane {
    Vector normal;
    double offset;  // of the plane along the normal
    double distance(const Point& at) const { return normal.dot(at) - offset; }
  };
  struct Planes {
    std::array<Plane, 2> planes;
    std::size_t count = 0;  // 0: there are none near, or not all lies in one or two
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
