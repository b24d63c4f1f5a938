#include "orchard/voronoi/power.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace orchard {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase = CGAL::Regular_triangulation_cell_base_3<Kernel>;
using Regular = CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

// In diagonals: the distance of extra points that surround all balls. No place in the box belongs to them, and they
// make all cells finite.
constexpr double kFar = 16;

class Builder {
 public:
  Builder(std::span<const Sphere> balls, const Box& box) : count_(static_cast<Index>(balls.size())) {
    Box all = box;
    std::vector<std::pair<Regular::Weighted_point, Index>> sites;
    for (Index i = 0; i < count_; ++i) {
      const auto& [center, radius] = balls[i];
      all.extend(center - Vector::Constant(radius)).extend(center + Vector::Constant(radius));
      sites.emplace_back(Regular::Weighted_point({center.x(), center.y(), center.z()}, radius * radius), i);
    }
    const double far = kFar * std::max(all.diagonal().norm(), 1e-300);
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        Point place = all.center();
        place[axis] += side * far;
        sites.emplace_back(Regular::Weighted_point({place.x(), place.y(), place.z()}, 0),
                           count_ + static_cast<Index>(sites.size()));
      }
    }
    regular_.insert(sites.begin(), sites.end());
  }

  PowerDiagram run(std::span<const Sphere> balls) {
    add_vertices();
    add_edges();
    add_facets();
    find_centers(balls);
    const auto by_balls = [](const auto& a, const auto& b) { return a.balls < b.balls; };
    std::sort(diagram_.vertices.begin(), diagram_.vertices.end(), by_balls);
    std::sort(diagram_.edges.begin(), diagram_.edges.end(), by_balls);
    std::sort(diagram_.facets.begin(), diagram_.facets.end(), by_balls);
    return std::move(diagram_);
  }

 private:
  template <std::size_t kCount>
  bool ours(std::array<Index, kCount>& balls) const {
    std::sort(balls.begin(), balls.end());
    return balls.back() < count_;
  }
  Point dual(Regular::Cell_handle cell) const {
    const auto place = regular_.dual(cell);
    return {place.x(), place.y(), place.z()};
  }

  void add_vertices() {
    for (const auto cell : regular_.finite_cell_handles()) {
      std::array<Index, 4> balls;
      for (int i = 0; i < 4; ++i) balls[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
      if (ours(balls)) diagram_.vertices.push_back({balls, dual(cell)});
    }
  }
  void add_edges() {
    for (const auto& [cell, side] : regular_.finite_facets()) {
      std::array<Index, 3> balls;
      for (int i = 0; i < 3; ++i) balls[static_cast<std::size_t>(i)] = cell->vertex((side + 1 + i) % 4)->info();
      const auto beyond = cell->neighbor(side);
      if (!ours(balls) || regular_.is_infinite(cell) || regular_.is_infinite(beyond)) continue;
      diagram_.edges.push_back({balls, {dual(cell), dual(beyond)}});
    }
  }
  void add_facets() {
    for (const auto& edge : regular_.finite_edges()) {
      std::array<Index, 2> balls{edge.first->vertex(edge.second)->info(), edge.first->vertex(edge.third)->info()};
      if (!ours(balls)) continue;
      PowerDiagram::Facet facet{balls, {}};
      auto around = regular_.incident_cells(edge);
      const auto first = around;
      do {
        if (!regular_.is_infinite(around)) facet.corners.push_back(dual(around));
      } while (++around != first);
      diagram_.facets.push_back(std::move(facet));
    }
  }
  void find_centers(std::span<const Sphere> balls) {
    for (Index i = 0; i < count_; ++i) {
      const Point& center = balls[i].center;
      const auto own = regular_.nearest_power_vertex({center.x(), center.y(), center.z()});
      diagram_.holds_center.push_back(own->info() == i ? 1 : 0);
    }
  }

  Index count_;
  Regular regular_;
  PowerDiagram diagram_;
};

}  // namespace

PowerDiagram power_diagram(std::span<const Sphere> balls, const Box& box) { return Builder(balls, box).run(balls); }

}  // namespace orchard
