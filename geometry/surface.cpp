#include "orchard/geometry/surface.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "half_edges.h"
#include "orchard/geometry/angle.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/min_ball.h"
#include "orchard/geometry/tolerance.h"
#include "query/triangle_tree.h"
#include "query/uncut_parts.h"
#include "repair/self_intersections_of_tree.h"

namespace orchard {
namespace {

// Returns twice the area vector, computed from the two shortest edges, where rounding errors are smallest. It is zero
// if it consists of rounding errors only, by the criterion of check_mesh().
Vector area_vector(const std::array<Point, 3>& p) {
  std::array<Vector, 3> edges;  // opposite to the corners
  std::array<double, 3> lengths{};
  std::size_t apex = 0;  // opposite to the longest edge
  for (std::size_t i = 0; i < 3; ++i) {
    edges[i] = p[(i + 2) % 3] - p[(i + 1) % 3];
    lengths[i] = edges[i].norm();
    if (lengths[i] > lengths[apex]) apex = i;
  }
  const std::size_t b = (apex + 1) % 3, c = (apex + 2) % 3;
  const Vector cross = edges[b].cross(edges[c]);
  return cross.norm() <= tolerance::kNoArea * lengths[b] * lengths[c] ? Vector::Zero() : cross;
}

TriangleMesh validated(TriangleMesh mesh) {
  validate(mesh);
  return mesh;
}

bool is_edge(Feature feature) { return feature >= Feature::edge0 && feature <= Feature::edge2; }
std::size_t edge_of(Feature feature) {
  return static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::edge0);
}
std::size_t corner_of(Feature feature) {
  return static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::vertex0);
}

}  // namespace

struct Surface::Data {
  TriangleMesh mesh;
  MeshReport report;
  Box box;
  BoundingBall ball_kind;
  Sphere ball;
  std::vector<Vector> normals;
  std::vector<double> areas;
  std::vector<std::array<Index, 3>> neighbors;
  Rows triangles_around;
  std::vector<Vector> vertex_normals;  // pseudonormals
  Clusters clusters;
  detail::TriangleTree tree;

  Data(TriangleMesh input, BoundingBall kind)
      : mesh(validated(std::move(input))),
        report(check_mesh(mesh)),
        ball_kind(kind),
        ball(kind == BoundingBall::minimal ? minimal_ball(mesh.vertices) : ritter_ball(mesh.vertices)),
        neighbors(triangle_neighbors(mesh)),
        triangles_around(triangles_around_vertices(mesh)),
        tree(mesh) {
    for (const Point& p : mesh.vertices) box.extend(p);
    find_normals();
    clusters = find_clusters(normals, neighbors, tolerance::kCoplanarAngle);
  }
  Data(const Data&) = delete;

  // These are computed on demand, because many applications need neither.
  const std::vector<std::array<Index, 2>>& self_intersections() const {
    std::call_once(cuts_found_, [&] { cuts_ = detail::self_intersections(mesh, tree); });
    return cuts_;
  }
  const detail::UncutParts& uncut_parts() const {
    std::call_once(parts_found_, [&] { parts_.emplace(mesh, tree, self_intersections()); });
    return *parts_;
  }

  void find_normals() {
    normals.resize(mesh.triangles.size());
    areas.resize(mesh.triangles.size());
    vertex_normals.assign(mesh.vertices.size(), Vector::Zero());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& corners = mesh.triangles[t];
      const std::array<Point, 3> p{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
      const Vector twice_area = area_vector(p);
      const double length = twice_area.norm();
      areas[t] = 0.5 * length;
      normals[t] = length > 0 ? Vector(twice_area / length) : Vector::Zero();
      if (length == 0) continue;
      for (std::size_t i = 0; i < 3; ++i)
        vertex_normals[corners[i]] += angle_between(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]) * normals[t];
    }
    for (Vector& normal : vertex_normals) normal.normalize();
  }

 private:
  mutable std::once_flag cuts_found_, parts_found_;
  mutable std::vector<std::array<Index, 2>> cuts_;
  mutable std::optional<detail::UncutParts> parts_;
};

Surface::Surface(TriangleMesh mesh, BoundingBall kind) : data_(std::make_unique<const Data>(std::move(mesh), kind)) {}
Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

const TriangleMesh& Surface::mesh() const { return data_->mesh; }
const MeshReport& Surface::report() const { return data_->report; }
const Box& Surface::bounding_box() const { return data_->box; }
const Sphere& Surface::bounding_ball() const { return data_->ball; }
BoundingBall Surface::ball_kind() const { return data_->ball_kind; }
const Vector& Surface::normal(Index triangle) const { return data_->normals[triangle]; }
double Surface::area(Index triangle) const { return data_->areas[triangle]; }
const std::array<Index, 3>& Surface::neighbors(Index triangle) const { return data_->neighbors[triangle]; }
std::span<const Index> Surface::triangles_around(Index vertex) const { return data_->triangles_around[vertex]; }
const Clusters& Surface::clusters() const { return data_->clusters; }

std::array<Point, 3> Surface::corners(Index triangle) const {
  const auto& [a, b, c] = data_->mesh.triangles[triangle];
  return {data_->mesh.vertices[a], data_->mesh.vertices[b], data_->mesh.vertices[c]};
}

void Surface::triangles_at(Index triangle, Feature feature, std::vector<Index>& out) const {
  out.clear();
  if (feature >= Feature::vertex0) {
    const auto fan = triangles_around(data_->mesh.triangles[triangle][corner_of(feature)]);
    out.assign(fan.begin(), fan.end());
    return;
  }
  out.push_back(triangle);
  if (!is_edge(feature)) return;
  const Index other = neighbors(triangle)[edge_of(feature)];
  if (other != kNone) out.insert(other < triangle ? out.begin() : out.end(), other);
}

Vector Surface::pseudonormal(Index triangle, Feature feature) const {
  if (feature >= Feature::vertex0) return data_->vertex_normals[data_->mesh.triangles[triangle][corner_of(feature)]];
  const Vector& own = normal(triangle);
  const Index other = is_edge(feature) ? neighbors(triangle)[edge_of(feature)] : kNone;
  return other == kNone ? own : Vector((own + normal(other)).normalized());
}

ClosestPoint Surface::closest(const Point& query) const { return data_->tree.closest(query); }

ClosestPoint Surface::closest_within(const Point& query, double distance) const {
  return data_->tree.closest_within(query, distance);
}

double Surface::signed_distance(const Point& query) const {
  ClosestPoint nearest;
  return signed_distance(query, nearest);
}

double Surface::signed_distance(const Point& query, ClosestPoint& nearest) const {
  require_inside();
  detail::NearestTriangles triangles;
  nearest = data_->tree.closest(query, triangles);
  if (nearest.distance == 0 || !std::isfinite(nearest.distance) || !bounding_box().contains(query))
    return nearest.distance;
  return data_->uncut_parts().inside(query, triangles) ? -nearest.distance : nearest.distance;
}

int Surface::winding_number(const Point& query) const {
  require_inside();
  return bounding_box().contains(query) ? data_->tree.winding_number(query) : 0;
}

void Surface::require_inside() const {
  if (!solid()) throw InputError("the surface has no inside: " + report().faults() + "; repair the mesh first");
}

const std::vector<std::array<Index, 2>>& Surface::self_intersections() const { return data_->self_intersections(); }

void Surface::visit_nearest(const Point& query, const std::function<double(Index)>& visit) const {
  data_->tree.visit_nearest(query, visit);
}
double Surface::max_reach(const std::array<Sphere, 3>& balls, const Point& middle, double enough) const {
  return data_->tree.max_reach(balls, middle, enough);
}
void Surface::triangles_near(const Sphere& ball, std::vector<Index>& out) const { data_->tree.near(ball, out); }
void Surface::triangles_near(const Sphere& ball, const std::function<bool(const Box&)>& is_out,
                             std::vector<Index>& out) const {
  data_->tree.near(ball, is_out, out);
}
void Surface::triangles_overlapping(const std::array<Point, 3>& triangle, std::vector<Index>& out) const {
  data_->tree.overlapping(triangle, out);
}

}  // namespace orchard
