#include "drop_flakes.h"

#include <algorithm>
#include <vector>

#include "../axis/incidence.h"
#include "orchard/geometry/disjoint_sets.h"
#include "small_pieces.h"

namespace orchard::detail {
namespace {

class FlakeDropper {
 public:
  explicit FlakeDropper(BallComplex& complex)
      : complex_(complex),
        at_(complex.edges, complex.triangles, complex.size()),
        sheet_of_triangle_(complex.triangles.size()) {}

  Index run(const CoverGuard* guard, std::vector<Sphere>* around) {
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      const auto triangles = at_.triangles_at[e];
      if (triangles.size() == 2) sheet_of_triangle_.unite(triangles[0], triangles[1]);
    }
    find_joints();
    measure();
    choose(guard);
    if (around) add_spheres(*around);
    const std::size_t before = complex_.triangles.size();
    collapse(complex_, doomed(), std::vector<double>(complex_.size(), 0));
    return static_cast<Index>(before - complex_.triangles.size());
  }

 private:
  // The edges at which sheets meet, and how many of them each has.
  void find_joints() {
    joint_.assign(complex_.triangles.size(), kNone);
    joints_.assign(complex_.triangles.size(), 0);
    for (Index e = 0; e < complex_.edges.size(); ++e) {
      if (at_.triangles_at[e].size() < 3) continue;
      for (const Index t : at_.triangles_at[e]) {
        joint_[sheet(t)] = e;
        ++joints_[sheet(t)];
      }
    }
  }

  // How far each sheet with one joint reaches from the nearer end of that, and its largest radius.
  void measure() {
    reach_.assign(complex_.triangles.size(), 0);
    radius_.assign(complex_.triangles.size(), 0);
    for (Index t = 0; t < complex_.triangles.size(); ++t) {
      const Index s = sheet(t);
      if (joints_[s] != 1) continue;
      const auto& [a, b] = complex_.edges[joint_[s]];
      for (const Index v : complex_.triangles[t]) {
        const auto way = [&](Index end) { return (complex_.balls[v].center - complex_.balls[end].center).norm(); };
        reach_[s] = std::max(reach_[s], std::min(way(a), way(b)));
        radius_[s] = std::max(radius_[s], complex_.balls[v].radius);
      }
    }
  }

  bool is_small(Index s) const {
    if (joints_[s] != 1) return false;
    const auto& [a, b] = complex_.edges[joint_[s]];
    return reach_[s] <= kPieceReach * std::max(complex_.balls[a].radius, complex_.balls[b].radius);
  }

  // The small ones, but for those that cover something alone.
  void choose(const CoverGuard* guard) {
    goes_.assign(complex_.triangles.size(), 0);
    std::vector<Index> sheet_of_edge(complex_.edges.size(), kNone);
    for (Index t = 0; t < complex_.triangles.size(); ++t) {
      const Index s = sheet(t);
      if (!is_small(s)) continue;
      goes_[s] = 1;
      for (const Index e : at_.sides[t]) {
        if (e != joint_[s]) sheet_of_edge[e] = s;
      }
    }
    if (!guard) return;
    const std::vector<std::uint8_t> needed = guard->needed(complex_, sheet_of_edge);
    for (Index s = 0; s < goes_.size(); ++s) {
      if (needed[s] != 0) goes_[s] = 0;
    }
  }

  void add_spheres(std::vector<Sphere>& around) {
    for (Index t = 0; t < complex_.triangles.size(); ++t) {
      if (sheet(t) != t || !goes_[t]) continue;
      // One sphere: what is between balls near one end and near the other need not be in either's.
      const auto& [a, b] = complex_.edges[joint_[t]];
      const double length = (complex_.balls[a].center - complex_.balls[b].center).norm();
      around.push_back({.center = complex_.balls[a].center, .radius = length + reach_[t] + radius_[t]});
    }
  }

  Doomed doomed() {
    Doomed doomed(complex_);
    for (Index t = 0; t < complex_.triangles.size(); ++t) {
      const Index s = sheet(t);
      if (!goes_[s]) continue;
      for (const Index e : at_.sides[t]) {
        if (e != joint_[s]) doomed.edges[e] = 1;
      }
      const auto& [a, b] = complex_.edges[joint_[s]];
      for (const Index v : complex_.triangles[t]) {
        if (v != a && v != b) doomed.vertices[v] = 1;
      }
    }
    return doomed;
  }

  Index sheet(Index t) { return static_cast<Index>(sheet_of_triangle_.root(t)); }

  BallComplex& complex_;
  const CellIncidence at_;
  DisjointSets sheet_of_triangle_;
  std::vector<std::uint8_t> goes_;      // of each sheet: whether it is to go
  std::vector<Index> joint_, joints_;   // of each sheet: the last of its joints, how many
  std::vector<double> reach_, radius_;  // of each sheet, mesh units
};

}  // namespace

Index drop_flakes(BallComplex& complex, const CoverGuard* guard, std::vector<Sphere>* around) {
  return FlakeDropper(complex).run(guard, around);
}

}  // namespace orchard::detail
