#pragma once
#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

namespace orchard::detail {

// Finds the parts of lines in a picture that triangles and spheres hide. Coordinates are those of the picture: x to the
// right, y upward, and z towards the eye, which is infinitely far away.
class Occluders {
 public:
  // A line that is nearer than `slack` to a surface, along z, is not hidden by it, because lines lie on the surfaces
  // that they belong to.
  explicit Occluders(double slack) : slack_(slack) {}

  void add_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  // A line on the sphere that is off by less than 0.2 % of its radius is not hidden by it.
  void add_sphere(const Eigen::Vector3d& center, double radius);
  // Sorts what was added into cells. Call it once, before visible().
  void finish();

  // Returns the parts [begin, end] of the segment from a to b, 0 being a and 1 being b, that nothing hides, in order.
  // Precondition: finish() was called. The time grows with the number of occluders near the segment.
  std::vector<std::pair<double, double>> visible(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

 private:
  struct Sphere {
    Eigen::Vector3d center;
    double radius;
  };
  using Hidden = std::vector<std::pair<double, double>>;
  using Box = std::array<int, 4>;  // of cells: from x, y to x, y inclusive

  Box cells_of(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const;
  void sort(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& boxes);
  void hide_by(int occluder, const Eigen::Vector3d& a, const Eigen::Vector3d& b, Hidden& hidden) const;
  void hide_by(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
               Hidden& hidden) const;
  static void hide_by(const Sphere& sphere, const Eigen::Vector3d& a, const Eigen::Vector3d& b, Hidden& hidden);

  std::size_t cell_at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  }

  double slack_;
  std::vector<std::array<Eigen::Vector3d, 3>> triangles_;
  std::vector<Sphere> spheres_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double cell_ = 1;
  int columns_ = 0, rows_ = 0;
  // Where the list of each cell begins; the lists have numbers of triangles, then of spheres.
  std::vector<int> begin_, sorted_;
};

}  // namespace orchard::detail
