#include "orchard/medial/shape_measures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "../axis/incidence.h"
#include "../triangle_quality.h"
#include "orchard/geometry/disjoint_sets.h"

namespace orchard {
namespace {

constexpr double kBadTriangle = 0.1;
constexpr Index kTinySheet = 3;

class Measurer {
 public:
  Measurer(const MedialMesh& mesh, double diagonal)
      : mesh_(mesh), diagonal_(diagonal), at_(mesh.edges, mesh.triangles, mesh.size()) {}

  ShapeMeasures run() {
    measure_edges();
    measure_sheets();
    measure_triangles();
    measure_borders();
    return result_;
  }

 private:
  double length(const std::array<Index, 2>& edge) const {
    return (mesh_.centers[edge[0]] - mesh_.centers[edge[1]]).norm() / diagonal_;
  }

  void measure_edges() {
    std::vector<double> lengths;
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      const std::size_t triangles = at_.triangles_at[e].size();
      const double own = length(mesh_.edges[e]);
      if (triangles == 0) {
        result_.curve_length += own;
        continue;
      }
      lengths.push_back(own);
      if (triangles > 2) result_.seam_length += own;
    }
    std::sort(lengths.begin(), lengths.end());
    result_.edge_spread = std::nan("");
    if (lengths.empty()) return;
    const double tenth = lengths[lengths.size() / 10];
    result_.edge_spread = tenth > 0 ? lengths[lengths.size() * 9 / 10] / tenth : HUGE_VAL;
  }

  void measure_sheets() {
    DisjointSets sets(mesh_.triangles.size());
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      const auto around = at_.triangles_at[e];
      if (around.size() == 2) sets.unite(around[0], around[1]);
    }
    struct Sheet {
      Box box;
      double radius = 0;
      Index triangles = 0;
    };
    std::map<Index, Sheet> sheets;
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      Sheet& sheet = sheets[sets.root(t)];
      ++sheet.triangles;
      for (const Index corner : mesh_.triangles[t]) {
        sheet.box.extend(mesh_.centers[corner]);
        sheet.radius = std::max(sheet.radius, mesh_.radii[corner]);
      }
    }
    result_.sheets = static_cast<Index>(sheets.size());
    for (const auto& [root, sheet] : sheets) {
      if (sheet.box.diagonal().norm() < sheet.radius) ++result_.small_sheets;
      if (sheet.triangles <= kTinySheet) ++result_.tiny_sheets;
    }
  }

  void measure_triangles() {
    std::vector<double> all;
    for (const auto& [a, b, c] : mesh_.triangles)
      all.push_back(detail::triangle_quality(mesh_.centers[a], mesh_.centers[b], mesh_.centers[c]));
    result_.quality_mean = result_.quality_5 = result_.quality_below = std::nan("");
    if (all.empty()) return;
    std::sort(all.begin(), all.end());
    const double count = static_cast<double>(all.size());
    result_.quality_mean = std::accumulate(all.begin(), all.end(), 0.0) / count;
    result_.quality_5 = all[all.size() / 20];
    result_.quality_below =
        static_cast<double>(std::lower_bound(all.begin(), all.end(), kBadTriangle) - all.begin()) / count;
  }

  void measure_borders() {
    std::map<Index, std::vector<Index>> next;
    for (const Index e : at_.border_edges()) {
      const auto& [a, b] = mesh_.edges[e];
      next[a].push_back(b), next[b].push_back(a);
    }
    Index turns = 0;
    double way = 0, shortcut = 0;
    for (const auto& [vertex, both] : next) {
      if (both.size() > 2) ++result_.forked_borders;
      if (both.size() != 2) continue;
      ++result_.border_vertices;
      const Vector in = mesh_.centers[vertex] - mesh_.centers[both[0]];
      const Vector on = mesh_.centers[both[1]] - mesh_.centers[vertex], chord = in + on;
      const double product = in.norm() * on.norm();
      if (product > 0 && in.dot(on) < 0.5 * product) ++turns;
      way += in.norm() + on.norm();
      shortcut += chord.norm();
      const double height = chord.norm() > 0 ? in.cross(chord).norm() / chord.norm() : in.norm();
      if (height > chord.norm() / 2) ++result_.flaps;
    }
    const bool any = result_.border_vertices > 0;
    result_.border_turns = any ? static_cast<double>(turns) / result_.border_vertices : std::nan("");
    result_.border_roughness = shortcut > 0 ? way / shortcut : std::nan("");
  }

  const MedialMesh& mesh_;
  double diagonal_;
  detail::CellIncidence at_;
  ShapeMeasures result_;
};

}  // namespace

ShapeMeasures shape_measures(const MedialMesh& mesh, double diagonal) { return Measurer(mesh, diagonal).run(); }

}  // namespace orchard
