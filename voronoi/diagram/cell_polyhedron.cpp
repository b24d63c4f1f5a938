#include "orchard/voronoi/cell_polyhedron.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace orchard {
namespace {

// In diagonals of the box: corners nearer to a cutting plane than this, a thousand rounding errors, count as lying on
// it.
constexpr double kOnPlane = 1e-13;

struct Plane {
  Vector normal;  // unit vector; the side that it points to is cut off
  double offset;
  Index beyond;
};

CellPolyhedron polyhedron_of(const Box& box) {
  CellPolyhedron polyhedron;
  for (unsigned i = 0; i < 8; ++i)
    polyhedron.corners.emplace_back(box.corner(static_cast<Box::CornerType>(i)));  // bit 0: high x, 1: y, 2: z
  for (const auto& face :
       {std::array<Index, 4>{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
    polyhedron.faces.items.insert(polyhedron.faces.items.end(), face.begin(), face.end());
    polyhedron.faces.close_row();
    polyhedron.neighbors.push_back(kNone);
  }
  return polyhedron;
}

// Cuts a convex polyhedron by one plane.
class Cut {
 public:
  Cut(CellPolyhedron& polyhedron, const Plane& plane, double tolerance) : from_(polyhedron), plane_(plane) {
    for (const Point& corner : from_.corners) {
      const double height = plane.normal.dot(corner) - plane.offset;
      heights_.push_back(std::abs(height) <= tolerance ? 0 : height);
    }
  }

  void run() {
    if (std::none_of(heights_.begin(), heights_.end(), [](double h) { return h > 0; })) return;
    if (std::any_of(heights_.begin(), heights_.end(), [](double h) { return h < 0; })) {
      keep_corners();
      for (Index face = 0; face < from_.faces.size(); ++face) cut_face(face);
      add_cap();
    }
    from_ = std::move(result_);
  }

 private:
  void keep_corners() {
    kept_.assign(from_.corners.size(), kNone);
    for (Index i = 0; i < from_.corners.size(); ++i) {
      if (heights_[i] > 0) continue;
      kept_[i] = add_corner(from_.corners[i]);
      if (heights_[i] == 0) cap_.push_back(kept_[i]);
    }
  }

  Index add_corner(const Point& corner) {
    result_.corners.push_back(corner);
    return static_cast<Index>(result_.corners.size() - 1);
  }

  Index crossing(Index a, Index b) {
    if (a > b) std::swap(a, b);
    const auto [at, fresh] = crossings_.try_emplace({a, b}, kNone);
    if (fresh) {
      const double t = heights_[a] / (heights_[a] - heights_[b]);
      at->second = add_corner(from_.corners[a] + t * (from_.corners[b] - from_.corners[a]));
      cap_.push_back(at->second);
    }
    return at->second;
  }

  void cut_face(Index face) {
    const auto corners = from_.faces[face];
    std::vector<Index>& items = result_.faces.items;
    const std::size_t begin = items.size();
    bool inside = false;  // whether more of it than an edge in the plane is left
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Index a = corners[i], b = corners[(i + 1) % corners.size()];
      inside = inside || heights_[a] < 0;
      if (kept_[a] != kNone) items.push_back(kept_[a]);
      if (heights_[a] * heights_[b] < 0) items.push_back(crossing(a, b));
    }
    if (!inside || items.size() - begin < 3) return items.resize(begin);
    result_.faces.close_row();
    result_.neighbors.push_back(from_.neighbors[face]);
  }

  // Adds the new face: all corners in the plane, in the order of their angles.
  void add_cap() {
    if (cap_.size() < 3) return;
    Point middle = Point::Zero();
    for (const Index corner : cap_) middle += result_.corners[corner];
    middle /= static_cast<double>(cap_.size());
    const Vector u = plane_.normal.unitOrthogonal(), v = plane_.normal.cross(u);
    std::vector<std::pair<double, Index>> around;
    for (const Index corner : cap_) {
      const Vector from_middle = result_.corners[corner] - middle;
      around.emplace_back(std::atan2(from_middle.dot(v), from_middle.dot(u)), corner);
    }
    std::sort(around.begin(), around.end());
    for (const auto& [angle, corner] : around) result_.faces.items.push_back(corner);
    result_.faces.close_row();
    result_.neighbors.push_back(plane_.beyond);
  }

  CellPolyhedron& from_;
  const Plane& plane_;
  CellPolyhedron result_;
  std::vector<double> heights_;
  std::vector<Index> kept_, cap_;
  std::map<std::pair<Index, Index>, Index> crossings_;
};

}  // namespace

CellPolyhedron clipped_cell(const VoronoiDiagram& diagram, const VoronoiCells& cells, Index point, const Box& box) {
  if (cells.vertices(point).empty() || box.isEmpty()) return {};
  std::vector<std::pair<double, Index>> neighbors;
  const Point& center = diagram.points[point];
  for (const VoronoiFace& face : cells.faces(point))
    neighbors.emplace_back((diagram.points[face.second_point()] - center).squaredNorm(), face.second_point());
  std::sort(neighbors.begin(), neighbors.end());  // the nearest neighbours cut off most, so they come first
  CellPolyhedron polyhedron = polyhedron_of(box);
  for (const auto& [squared, other] : neighbors) {
    const Vector normal = (diagram.points[other] - center).normalized();
    const Plane plane{normal, normal.dot(0.5 * (diagram.points[other] + center)), other};
    Cut(polyhedron, plane, kOnPlane * box.diagonal().norm()).run();
  }
  return polyhedron;
}

double volume(const CellPolyhedron& polyhedron) {
  double six = 0;
  for (Index face = 0; face < polyhedron.faces.size(); ++face) {
    const auto corners = polyhedron.faces[face];
    const auto from_origin = [&](std::size_t i) -> Vector {
      return polyhedron.corners[corners[i]] - polyhedron.corners[0];
    };
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      six += from_origin(0).dot(from_origin(i).cross(from_origin(i + 1)));
  }
  return six / 6;
}

}  // namespace orchard
