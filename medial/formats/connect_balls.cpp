#include <algorithm>
#include <cstdint>
#include <map>

#include "orchard/geometry/error.h"
#include "orchard/medial/read_axis.h"
#include "orchard/voronoi/power.h"

namespace orchard {
namespace {

class Connector {
 public:
  Connector(const Surface& surface, const MedialMesh& balls) : surface_(surface), balls_(balls) {
    std::vector<Sphere> spheres;
    for (Index i = 0; i < balls.size(); ++i) spheres.push_back({balls.centers[i], balls.radii[i]});
    diagram_ = power_diagram(spheres, surface.bounding_box());
  }

  ConnectedBalls run() {
    for (const PowerDiagram::Vertex& vertex : diagram_.vertices) {
      if (is_inside(vertex.position)) add_tetrahedron(vertex.balls);
    }
    for (const PowerDiagram::Edge& edge : diagram_.edges) {
      if (meets(edge)) add_triangle(edge.balls);
    }
    for (const PowerDiagram::Facet& facet : diagram_.facets) {
      if (meets(facet)) result_.mesh.edges.push_back(facet.balls);
    }
    collapse();
    for (const auto& [triangle, tetrahedra] : triangles_) result_.mesh.triangles.push_back(triangle);
    keep_balls();
    complete(result_.mesh);
    return std::move(result_);
  }

 private:
  using Triangle = std::array<Index, 3>;

  bool is_inside(const Point& place) const { return place.allFinite() && surface_.inside(place); }
  bool touches(const Point& a, const Point& b, const Point& c) {
    if (!a.allFinite() || !b.allFinite() || !c.allFinite()) return false;
    surface_.triangles_overlapping({a, b, c}, found_);
    return !found_.empty();
  }
  bool meets(const PowerDiagram::Edge& edge) {
    return is_inside(edge.ends[0]) || is_inside(edge.ends[1]) || touches(edge.ends[0], edge.ends[1], edge.ends[1]);
  }
  bool meets(const PowerDiagram::Facet& facet) {
    for (std::size_t i = 0; i < facet.corners.size(); ++i) {
      if (is_inside(facet.corners[i])) return true;
      if (i >= 2 && touches(facet.corners[0], facet.corners[i - 1], facet.corners[i])) return true;
    }
    return false;
  }

  static std::array<Triangle, 4> sides(const std::array<Index, 4>& t) {
    return {Triangle{t[0], t[1], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[3]}, {t[1], t[2], t[3]}};
  }
  void add_tetrahedron(const std::array<Index, 4>& balls) {
    for (const Triangle& side : sides(balls)) {
      add_triangle(side);
      triangles_[side].push_back(static_cast<Index>(tetrahedra_.size()));
    }
    tetrahedra_.push_back(balls);
  }
  void add_triangle(const Triangle& t) { triangles_.try_emplace(t); }

  double area(const Triangle& t) const {
    const Point& a = balls_.centers[t[0]];
    return (balls_.centers[t[1]] - a).cross(balls_.centers[t[2]] - a).norm();
  }
  // Removes tetrahedra that have a free side, each through its largest free side (the first of equal ones), until none
  // is left.
  void collapse() {
    std::vector<std::uint8_t> gone(tetrahedra_.size(), 0);
    std::vector<Index> waiting;
    for (Index i = static_cast<Index>(tetrahedra_.size()); i-- > 0;) waiting.push_back(i);
    while (!waiting.empty()) {
      const Index i = waiting.back();
      waiting.pop_back();
      if (gone[i] != 0) continue;
      const Triangle* free = nullptr;
      const std::array<Triangle, 4> own = sides(tetrahedra_[i]);
      for (const Triangle& side : own) {
        if (triangles_.at(side).size() == 1 && (free == nullptr || area(side) > area(*free))) free = &side;
      }
      if (free == nullptr) continue;
      gone[i] = 1;
      for (const Triangle& side : own) {
        auto& around = triangles_.at(side);
        around.erase(std::remove(around.begin(), around.end(), i), around.end());
        waiting.insert(waiting.end(), around.begin(), around.end());
      }
      triangles_.erase(*free);
    }
    result_.tetrahedra = static_cast<Index>(std::count(gone.begin(), gone.end(), 0));
  }

  // Keeps the balls that have cells, and those that are alone in their part of the solid.
  void keep_balls() {
    MedialMesh& mesh = result_.mesh;
    std::vector<Index> number(balls_.centers.size(), kNone);
    for (const auto& [a, b] : mesh.edges) number[a] = number[b] = 0;
    for (const Triangle& t : mesh.triangles) {
      for (const Index corner : t) number[corner] = 0;
    }
    for (Index i = 0; i < balls_.size(); ++i) {
      if (number[i] == kNone && !(diagram_.holds_center[i] != 0 && is_inside(balls_.centers[i]))) {
        ++result_.left_out;
        continue;
      }
      number[i] = mesh.size();
      mesh.centers.push_back(balls_.centers[i]);
      mesh.radii.push_back(balls_.radii[i]);
    }
    for (auto& edge : mesh.edges) edge = {number[edge[0]], number[edge[1]]};
    for (Triangle& t : mesh.triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
  }

  const Surface& surface_;
  const MedialMesh& balls_;
  PowerDiagram diagram_;
  std::map<Triangle, std::vector<Index>> triangles_;  // the tetrahedra at each triangle
  std::vector<std::array<Index, 4>> tetrahedra_;
  std::vector<Index> found_;
  ConnectedBalls result_;
};

}  // namespace

ConnectedBalls connect_balls(const Surface& surface, const MedialMesh& balls) {
  if (!surface.solid())
    throw InputError("connecting balls needs a solid: " + surface.report().faults() + "; repair the mesh first");
  validate(balls);
  return Connector(surface, balls).run();
}

}  // namespace orchard
