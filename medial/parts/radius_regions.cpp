#include "radius_regions.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "../axis/incidence.h"

namespace orchard::detail {
namespace {

class RegionGrower {
 public:
  RegionGrower(const MedialMesh& mesh, double significance)
      : mesh_(mesh), significance_(significance), parents_(mesh.centers.size(), kNone), order_(mesh.centers.size()) {
    std::vector<std::array<Index, 2>> pairs;
    for (const auto& [a, b] : mesh.edges) pairs.insert(pairs.end(), {{a, b}, {b, a}});
    neighbors_ = rows_of(pairs, mesh.size());
    std::iota(order_.begin(), order_.end(), Index{0});
    std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return is_larger(a, b); });
  }

  RadiusRegions run() {
    for (const Index vertex : order_) add(vertex);
    RadiusRegions result;
    std::vector<Index> numbers(mesh_.centers.size(), kNone);
    for (const Index vertex : order_) {
      if (root(vertex) == vertex) numbers[vertex] = result.count++;
    }
    for (Index vertex = 0; vertex < mesh_.size(); ++vertex) result.of_vertex.push_back(numbers[root(vertex)]);
    for (const auto& [roots, neck] : necks_) {
      // After the two sides met at this neck, either may have merged with another side across a wider neck.
      const Index a = numbers[root(roots.first)], b = numbers[root(roots.second)];
      if (a == b) continue;
      result.necks.push_back(neck);
      result.necks.back().a = std::min(a, b);
      result.necks.back().b = std::max(a, b);
    }
    keep_widest(result.necks);
    return result;
  }

 private:
  bool is_larger(Index a, Index b) const {
    return mesh_.radii[a] != mesh_.radii[b] ? mesh_.radii[a] > mesh_.radii[b] : a < b;
  }
  // Returns the vertex with the largest ball in the region of a vertex.
  Index root(Index vertex) {
    while (parents_[vertex] != vertex) vertex = parents_[vertex] = parents_[parents_[vertex]];
    return vertex;
  }

  void add(Index vertex) {
    Index best = kNone;
    for (const Index neighbor : neighbors_[vertex]) {
      if (parents_[neighbor] != kNone && (best == kNone || is_larger(neighbor, best))) best = neighbor;
    }
    parents_[vertex] = best == kNone ? vertex : root(best);
    if (best == kNone) return;
    for (const Index neighbor : neighbors_[vertex]) {
      if (parents_[neighbor] == kNone) continue;
      Index larger = root(vertex), smaller = root(neighbor);
      if (larger == smaller) continue;
      if (is_larger(smaller, larger)) std::swap(larger, smaller);
      const double peak = mesh_.radii[smaller], here = mesh_.radii[vertex];
      const double significance = peak > 0 ? 1 - here / peak : 0;
      if (significance < significance_) {
        parents_[smaller] = larger;
      } else {
        necks_.try_emplace(
            std::pair(larger, smaller),
            SurfaceParts::Neck{.place = mesh_.centers[vertex], .radius = here, .significance = significance});
      }
    }
  }

  // Keeps only the widest of several necks between the same two regions.
  static void keep_widest(std::vector<SurfaceParts::Neck>& necks) {
    std::stable_sort(necks.begin(), necks.end(), [](const auto& x, const auto& y) {
      return std::tuple(x.a, x.b, -x.radius) < std::tuple(y.a, y.b, -y.radius);
    });
    const auto same = [](const auto& x, const auto& y) { return x.a == y.a && x.b == y.b; };
    necks.erase(std::unique(necks.begin(), necks.end(), same), necks.end());
    std::stable_sort(necks.begin(), necks.end(),
                     [](const auto& x, const auto& y) { return x.significance > y.significance; });
  }

  const MedialMesh& mesh_;
  const double significance_;
  Rows neighbors_;
  std::vector<Index> parents_;  // of each vertex that has been added
  std::vector<Index> order_;    // the vertices by radius, the largest first
  std::map<std::pair<Index, Index>, SurfaceParts::Neck> necks_;
};

}  // namespace

RadiusRegions radius_regions(const MedialMesh& mesh, double significance) {
  return RegionGrower(mesh, significance).run();
}

}  // namespace orchard::detail
