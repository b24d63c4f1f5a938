#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/random.h"

namespace orchard::test {

// Winding numbers by a loop over all triangles: crossings of a ray in a random direction, in plain floating point.
// Where a sign is not clear beyond any rounding another direction is tried. Shares nothing with the library.
class WindingOracle {
 public:
  explicit WindingOracle(const TriangleMesh& mesh, std::uint64_t seed = 1) {
    Box box;
    for (const Point& p : mesh.vertices) box.extend(p);
    center_ = box.center();
    scale_ = 1 / box.sizes().maxCoeff();
    Random random(seed, 77);
    const auto in_cube = [&] { return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    for (View& view : views_) {
      view.turn =
          Eigen::Quaterniond(random.uniform(0.1, 1), random.uniform(-1, 1), random.uniform(-1, 1), in_cube().x())
              .normalized()
              .toRotationMatrix();
      for (auto& lane : view.corner)
        for (auto& axis : lane) axis.reserve(mesh.triangles.size());
      for (const auto& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
          const Vector p = view.turn * (scale_ * (mesh.vertices[triangle[i]] - center_));
          for (int axis = 0; axis < 3; ++axis) view.corner[i][static_cast<std::size_t>(axis)].push_back(p[axis]);
        }
    }
  }

  // Nothing if no direction is clear: the query is all but on the surface.
  std::optional<int> winding(const Point& query) const {
    for (const View& view : views_)
      if (const auto found = winding(view, view.turn * (scale_ * (query - center_)))) return found;
    return std::nullopt;
  }

 private:
  struct View {
    Eigen::Matrix3d turn;
    std::array<std::array<std::vector<double>, 3>, 3> corner;  // [corner][axis]
  };
  static constexpr double kUnclear = 1e-14;  // beside determinants of lengths about one: fifty roundings

  static std::optional<int> winding(const View& view, const Vector& q) {
    const auto& [a, b, c] = view.corner;
    const std::size_t count = a[0].size();
    int sum = 0;
    bool clear = true;
    for (std::size_t t = 0; t < count; ++t) {
      const double ax = a[0][t] - q.x(), ay = a[1][t] - q.y(), bx = b[0][t] - q.x(), by = b[1][t] - q.y(),
                   cx = c[0][t] - q.x(), cy = c[1][t] - q.y();
      const double ab = ax * by - ay * bx, bc = bx * cy - by * cx, ca = cx * ay - cy * ax;
      const double min = std::min({ab, bc, ca}), max = std::max({ab, bc, ca});
      if (min < -kUnclear && max > kUnclear) continue;
      if (min <= kUnclear && max >= -kUnclear) {  // a corner or an edge may be met
        if (std::max({ax, bx, cx}) < -kUnclear || std::min({ax, bx, cx}) > kUnclear ||
            std::max({ay, by, cy}) < -kUnclear || std::min({ay, by, cy}) > kUnclear)
          continue;
        clear = false;
        break;
      }
      const double az = a[2][t] - q.z(), bz = b[2][t] - q.z(), cz = c[2][t] - q.z();
      // The height of the plane over the query times the projected area.
      const double height = az * bc + bz * ca + cz * ab, area = ab + bc + ca;
      if (std::abs(height) < kUnclear * std::max({std::abs(az), std::abs(bz), std::abs(cz)}) + 1e-30) {
        clear = false;
        break;
      }
      if ((height > 0) == (area > 0)) sum += area > 0 ? 1 : -1;
    }
    return clear ? std::optional(sum) : std::nullopt;
  }

  Point center_;
  double scale_ = 1;
  std::array<View, 12> views_;
};

}  // namespace orchard::test
