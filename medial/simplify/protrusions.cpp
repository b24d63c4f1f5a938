#include "protrusions.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace orchard::detail {

namespace {

class Places {
 public:
  Places(const ContractibleMesh& mesh, const LookOptions& options) : mesh_(mesh), options_(options) {}

  void add_vertex(Index v) { add({v, v, v}, {1, 0, 0}); }
  void add_edge(Index a, Index b) {
    const double length = (mesh_.ball(a) - mesh_.ball(b)).head<3>().norm();
    const int count = static_cast<int>(std::clamp(std::ceil(length / options_.spacing), 1.0, 3.0));
    for (int k = 1; k <= count; ++k) {
      const double share = static_cast<double>(k) / (count + 1);
      add({a, b, a}, {1 - share, share, 0});
    }
  }
  void add_triangle(const ContractibleMesh::Triangle& corners) { add(corners, {1.0 / 3, 1.0 / 3, 1.0 / 3}); }

  std::vector<Protrusion> result;

 private:
  void add(const std::array<Index, 3>& corners, const std::array<double, 3>& weights) {
    const Protrusion place{corners, weights, 0, Vector::Zero()};
    if (corners[0] == corners[1] || place.ball(mesh_)[3] <= options_.max_radius) result.push_back(place);
  }

  const ContractibleMesh& mesh_;
  const LookOptions options_;
};

}  // namespace

std::vector<Protrusion> places_to_look(const ContractibleMesh& mesh, const LookOptions& options) {
  Places places(mesh, options);
  for (Index v = 0; v < mesh.size(); ++v) {
    if (!mesh.alive(v)) continue;
    places.add_vertex(v);
    if (!options.cells) continue;
    for (const Index other : mesh.neighbors(v)) {
      if (v < other) places.add_edge(v, other);
    }
  }
  if (!options.cells) return std::move(places.result);
  for (const auto& cell : mesh.maximal_cells()) {
    if (cell[2] != cell[0]) places.add_triangle(cell);
  }
  return std::move(places.result);
}

std::vector<Protrusion> places_around(const ContractibleMesh& mesh, Index a, Index b, const LookOptions& options) {
  Places places(mesh, options);
  for (const Index v : {a, b}) {
    if (v == b && a == b) break;
    const Index done = v == a ? kNone : a;
    places.add_vertex(v);
    for (const Index other : mesh.neighbors(v)) {
      if (other != done) places.add_edge(v, other);
    }
    for (const Index t : mesh.triangles_at(v)) {
      const auto& corners = mesh.triangle(t);
      if (std::find(corners.begin(), corners.end(), done) == corners.end()) places.add_triangle(corners);
    }
  }
  return std::move(places.result);
}

double protrusion_of(const Surface& surface, const Ball4& ball, double negligible, InsideBall& known, Vector& outward) {
  const Point center = ball.head<3>();
  if (known.holds(Sphere{center, std::max(0.0, ball[3] - negligible)})) return 0;
  ClosestPoint nearest;
  double depth = 0;
  if (known.holds(center)) {
    nearest = surface.closest_within(center, ball[3]);
    depth = nearest.triangle == kNone ? -ball[3] : -nearest.distance;
  } else {
    depth = surface.signed_distance(center, nearest);
  }
  if (depth < 0) known = {center, -depth};
  if (!(depth + ball[3] > negligible)) return 0;
  outward = nearest.distance > 0 ? Vector((depth > 0 ? 1.0 : -1.0) / nearest.distance * (center - nearest.position))
                                 : surface.pseudonormal(nearest.triangle, nearest.feature);
  return depth + ball[3];
}

std::vector<Protrusion> find_protrusions(const Surface& surface, const ContractibleMesh& mesh,
                                         const std::vector<Protrusion>& places, double negligible,
                                         std::span<InsideBall> known) {
  std::vector<Protrusion> result = places;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, result.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      result[i].value = protrusion_of(surface, result[i].ball(mesh), negligible, known[i], result[i].outward);
  });
  std::erase_if(result, [](const Protrusion& protrusion) { return !(protrusion.value > 0); });
  return result;
}

}  // namespace orchard::detail
