#include "orchard/geometry/clusters.h"

#include <cmath>

namespace orchard {

Clusters find_clusters(std::span<const Vector> normals, std::span<const std::array<Index, 3>> neighbors, double angle) {
  const auto count = static_cast<Index>(normals.size());
  Clusters clusters;
  clusters.of_triangle.assign(count, kNone);
  // |a - b| = 2 sin(angle / 2) is accurate for small angles, whereas the cosine is not.
  const double chord = 2 * std::sin(0.5 * angle);
  std::vector<Index> stack;
  Index cluster_count = 0;
  for (Index seed = 0; seed < count; ++seed) {
    if (clusters.of_triangle[seed] != kNone) continue;
    const Index cluster = cluster_count++;
    clusters.of_triangle[seed] = cluster;
    stack.push_back(seed);
    while (!stack.empty()) {
      const Index triangle = stack.back();
      stack.pop_back();
      for (const Index neighbor : neighbors[triangle]) {
        if (neighbor == kNone || clusters.of_triangle[neighbor] != kNone) continue;
        if ((normals[neighbor] - normals[seed]).norm() > chord) continue;
        clusters.of_triangle[neighbor] = cluster;
        stack.push_back(neighbor);
      }
    }
  }
  // A counting sort: triangles are ascending within each cluster.
  clusters.triangles.offsets.assign(cluster_count + 1, 0);
  clusters.triangles.items.resize(count);
  for (const Index cluster : clusters.of_triangle) ++clusters.triangles.offsets[cluster + 1];
  for (Index c = 0; c < cluster_count; ++c) clusters.triangles.offsets[c + 1] += clusters.triangles.offsets[c];
  std::vector<Index> next(clusters.triangles.offsets.begin(), clusters.triangles.offsets.end() - 1);
  for (Index t = 0; t < count; ++t) clusters.triangles.items[next[clusters.of_triangle[t]]++] = t;
  return clusters;
}

}  // namespace orchard
