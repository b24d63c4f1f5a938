#include "patches.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "orchard/geometry/disjoint_sets.h"

namespace orchard::detail {
namespace {

constexpr int kMaxJoins = 100;  // maximum number of rounds; each at least halves the number of small patches in a row

}  // namespace

PatchMesh::PatchMesh(const TriangleMesh& mesh) : sides_(mesh.triangles.size()) {
  std::vector<std::tuple<Index, Index, Index, Index>> edges;  // both corners, triangle, side
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const auto at = [&](Index k) { return mesh.vertices[corners[k % 3]]; };
    areas_.push_back((at(1) - at(0)).cross(at(2) - at(0)).norm() / 2);
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % 3]);
      edges.emplace_back(low, high, t, k);
      sides_[t][k].length = (at(k) - at(k + 1)).norm();
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const auto& [a, b, t, k] = edges[i];
    const auto& [c, d, u, m] = edges[i + 1];
    if (a != c || b != d) continue;
    sides_[t][k].triangle = u;
    sides_[u][m].triangle = t;
  }
}

void PatchMesh::smooth(std::vector<Index>& labels, int rounds) const {
  for (int round = 0; round < rounds; ++round) {
    bool changed = false;
    for (Index t = 0; t < labels.size(); ++t) {
      std::array<std::pair<Index, double>, 4> shares{};
      std::size_t count = 1;
      shares[0] = {labels[t], 0};
      for (const Side& side : sides_[t]) {
        if (side.triangle == kNone) continue;
        std::size_t i = 0;
        while (i < count && shares[i].first != labels[side.triangle]) ++i;
        if (i == count) shares[count++] = {labels[side.triangle], 0};
        shares[i].second += side.length;
      }
      std::size_t best = 0;
      for (std::size_t i = 1; i < count; ++i) {
        if (shares[i].second > shares[best].second) best = i;
      }
      if (best == 0) continue;
      labels[t] = shares[best].first;
      changed = true;
    }
    if (!changed) return;
  }
}

std::vector<Index> PatchMesh::patches(const std::vector<Index>& labels, Index& count) const {
  DisjointSets sets(labels.size());
  for (Index t = 0; t < labels.size(); ++t) {
    for (const Side& side : sides_[t]) {
      if (side.triangle != kNone && labels[side.triangle] == labels[t]) sets.unite(t, side.triangle);
    }
  }
  std::vector<Index> numbers(labels.size(), kNone);
  count = 0;
  for (Index t = 0; t < labels.size(); ++t) {
    const Index first = sets.root(t);  // the root is the lowest triangle of its set, so it already has a number
    numbers[t] = first == t ? count++ : numbers[first];
  }
  return numbers;
}

void PatchMesh::join_small(std::vector<Index>& labels, double min_area) const {
  for (int round = 0; round < kMaxJoins; ++round) {
    Index count = 0;
    const std::vector<Index> patch = patches(labels, count);
    std::vector<double> areas(count, 0);
    for (Index t = 0; t < labels.size(); ++t) areas[patch[t]] += areas_[t];
    // The lengths of the borders of small patches, by the adjacent larger patch.
    std::map<std::pair<Index, Index>, double> seams;
    for (Index t = 0; t < labels.size(); ++t) {
      const Index own = patch[t];
      if (!(areas[own] < min_area)) continue;
      for (const Side& side : sides_[t]) {
        const Index other = side.triangle == kNone ? own : patch[side.triangle];
        if (other != own && std::pair(areas[other], own) > std::pair(areas[own], other))
          seams[{own, other}] += side.length;
      }
    }
    if (seams.empty()) return;
    std::vector<std::pair<double, Index>> best(count, {0, kNone});
    for (const auto& [pair, length] : seams) {
      if (length > best[pair.first].first) best[pair.first] = {length, pair.second};
    }
    std::vector<Index> label_of(count);
    for (Index t = 0; t < labels.size(); ++t) label_of[patch[t]] = labels[t];
    for (Index t = 0; t < labels.size(); ++t) {
      if (const Index to = best[patch[t]].second; to != kNone) labels[t] = label_of[to];
    }
  }
}

}  // namespace orchard::detail
