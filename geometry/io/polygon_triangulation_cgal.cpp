#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "inexact_kernel.h"
#include "polygons.h"

namespace orchard {
namespace {

using detail::CgalKernel;
using Triangle = std::array<Index, 3>;
constexpr int kUnnumbered = -1000;  // marks a winding number that is not known yet

struct Winding {
  int number = kUnnumbered;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, CgalKernel>;  // the corner at this place
using FaceBase = CGAL::Triangulation_face_base_with_info_2<Winding, CgalKernel,
                                                           CGAL::Constrained_triangulation_face_base_2<CgalKernel>>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<CgalKernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Vertex = Cdt::Vertex_handle;

// The projection of a point to a plane in which the polygon is counter-clockwise.
class Projection {
 public:
  // Projects along the axis that is nearest to the normal. This keeps two coordinates exactly, and so keeps points on a
  // line.
  static Projection along_axis(const Vector& normal) {
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    Vector u = Vector::Unit((axis + 1) % 3), v = Vector::Unit((axis + 2) % 3);
    if (normal[axis] < 0) std::swap(u, v);
    return {u, v};
  }
  static Projection along(const Vector& normal) {
    Eigen::Index axis = 0;
    normal.cwiseAbs().minCoeff(&axis);
    const Vector u = normal.cross(Vector::Unit(axis)).normalized();
    return {u, normal.cross(u)};
  }
  CgalKernel::Point_2 operator()(const Point& p) const { return {u_.dot(p), v_.dot(p)}; }

 private:
  Projection(Vector u, Vector v) : u_(std::move(u)), v_(std::move(v)) {}
  Vector u_, v_;
};

class PolygonTriangulation {
 public:
  PolygonTriangulation(std::span<const Index> corners, std::span<const Point> vertices)
      : corners_(corners), vertices_(vertices) {}

  std::optional<std::vector<Triangle>> run(const Projection& projection) {
    try {
      if (!insert(projection) || cdt_.dimension() < 2) return std::nullopt;
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      return std::nullopt;
    }
    if (!cut_edges() || !wind()) return std::nullopt;
    std::vector<Triangle> triangles;
    for (const Cdt::Face_handle face : cdt_.finite_face_handles())
      if (face->info().number == 1)
        triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    keep_edges_whole(triangles);
    return triangles;
  }

 private:
  // Returns false if two different corners are projected to the same place.
  bool insert(const Projection& projection) {
    for (const Index corner : corners_) {
      const std::size_t before = cdt_.number_of_vertices();
      const Vertex vertex =
          cdt_.insert(projection(vertices_[corner]), outline_.empty() ? nullptr : outline_.back()->face());
      if (cdt_.number_of_vertices() > before) {
        vertex->info() = corner;
      } else if (vertices_[vertex->info()] != vertices_[corner]) {
        return false;
      }
      outline_.push_back(vertex);
    }
    for (std::size_t i = 0; i < outline_.size(); ++i)
      if (const auto [from, to] = edge(i); from != to) cdt_.insert_constraint(from, to);
    return true;
  }

  std::pair<Vertex, Vertex> edge(std::size_t i) const { return {outline_[i], outline_[(i + 1) % outline_.size()]}; }

  // Divides the edges of the outline at corners that lie on them. Counts how often each piece is passed from `first` to
  // `second`, minus how often it is passed back.
  bool cut_edges() {
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const auto [from, to] = edge(i);
      if (from == to) continue;
      std::vector<Vertex> passed{from};
      while (passed.back() != to) {
        Vertex next;
        Cdt::Face_handle face;
        int side = 0;
        if (!cdt_.includes_edge(passed.back(), to, next, face, side)) return false;
        ++passes_[{passed.back(), next}];
        --passes_[{next, passed.back()}];
        passed.push_back(next);
      }
      if (passed.size() > 2) cut_.push_back(std::move(passed));
    }
    return true;
  }

  int passes(Vertex from, Vertex to) const {
    const auto at = passes_.find({from, to});
    return at == passes_.end() ? 0 : at->second;
  }

  // Computes how often the outline winds around each face, from the outside in. Returns false if that is neither 0 nor
  // 1 somewhere.
  bool wind() {
    std::vector<Cdt::Face_handle> open{cdt_.infinite_face()};
    open.back()->info().number = 0;
    while (!open.empty()) {
      const Cdt::Face_handle face = open.back();
      open.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle across = face->neighbor(i);
        if (across->info().number != kUnnumbered) continue;
        // The face lies to the left of this edge, and the other face to the right.
        const int number = face->info().number - passes(face->vertex(Cdt::ccw(i)), face->vertex(Cdt::cw(i)));
        if (number != 0 && number != 1) return false;
        across->info().number = number;
        open.push_back(across);
      }
    }
    return true;
  }

  // The adjacent face has a whole edge where corners lie on the edge here, so triangles without area are added between
  // them.
  void keep_edges_whole(std::vector<Triangle>& triangles) const {
    std::set<std::pair<Vertex, Vertex>> ends;
    for (const auto& passed : cut_) ends.insert({passed.front(), passed.back()});
    for (const auto& passed : cut_) {
      // It is a bridge to a hole, with the polygon on both sides.
      if (ends.contains({passed.back(), passed.front()})) continue;
      for (std::size_t i = passed.size() - 1; i > 1; --i)
        triangles.push_back({passed.front()->info(), passed[i]->info(), passed[i - 1]->info()});
    }
  }

  std::span<const Index> corners_;
  std::span<const Point> vertices_;
  Cdt cdt_;
  std::vector<Vertex> outline_;
  std::map<std::pair<Vertex, Vertex>, int> passes_;
  std::vector<std::vector<Vertex>> cut_;  // edges with corners on them, from end to end
};

}  // namespace

std::optional<std::vector<Triangle>> triangulate_polygon(std::span<const Index> corners,
                                                         std::span<const Point> vertices, const Vector& normal) {
  if (corners.size() == 3) return std::vector<Triangle>{{corners[0], corners[1], corners[2]}};
  auto triangles = PolygonTriangulation(corners, vertices).run(Projection::along_axis(normal));
  // If the polygon is not quite planar, its outline may cross itself in one projection and not in another.
  if (!triangles) triangles = PolygonTriangulation(corners, vertices).run(Projection::along(normal));
  return triangles;
}

}  // namespace orchard
