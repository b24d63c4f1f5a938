#pragma once
#include <vtkPolyData.h>

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "camera.h"
#include "vector_file.h"

namespace orchard::detail {

// Finds the visible lines of one panel of a line drawing: outlines, sharp edges, and the borders, seams and curves of
// medial axes. Call lines() after everything has been added.
class LineArt {
 public:
  // `projection` maps to points from the lower left corner of a panel of this size. Lines end at its sides.
  LineArt(const Projection& projection, double width, double height)
      : projection_(projection), sides_(Eigen::Vector2d::Zero(), Eigen::Vector2d(width, height)) {}

  // Surfaces that are added after this are cut: the part with a x + b y + c z > d is left out.
  void clip(const std::array<double, 4>& plane) { plane_ = plane; }

  enum class Surface {
    axis,   // sheets: outlines, borders, seams; lines are curves
    solid,  // outlines, sharp edges and borders
    glass   // the same in grey; it hides only its own lines
  };
  void add_surface(vtkPolyData* surface, Surface kind);
  // Outlines of spheres with their radii from the point array `radius`, and the circles where they meet if these are
  // at most 20,000.
  void add_spheres(vtkPolyData* spheres);
  void add_points(vtkPolyData* points);

  // Returns the lines in the order in which they are drawn, from the lower left corner.
  std::vector<VectorLine> lines() const;

 private:
  enum class Kind { glass, dot, outline, sphere, sharp, curve, border, seam };
  struct Edge {
    int a, b;  // numbers of places
    Kind kind;
  };
  struct Ball {
    Eigen::Vector3d center;
    double radius;
  };

  int add_place(const Eigen::Vector3d& place);
  void add_edges(vtkPolyData* surface, Surface kind, int first);
  void add_circle(const Eigen::Vector3d& center, const Eigen::Vector3d& u, const Eigen::Vector3d& v);
  void add_meeting(const Ball& one, const Ball& other);
  bool on_cut(int a, int b) const;
  static VectorLine look_of(Kind kind);

  Projection projection_;
  Eigen::AlignedBox2d sides_;
  std::optional<std::array<double, 4>> plane_;
  std::vector<Eigen::Vector3d> places_;  // in the picture
  std::vector<bool> cut_;                // of each place: whether it lies on the cutting plane
  std::vector<Edge> edges_;
  std::vector<std::array<int, 3>> solid_, glass_;  // the triangles that hide lines
  std::vector<Ball> balls_;                        // in the picture
};

}  // namespace orchard::detail
