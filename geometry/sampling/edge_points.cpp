#include "edge_points.h"

#include <algorithm>
#include <cmath>

#include "half_edges.h"

namespace orchard::detail {
namespace {

struct BoundaryEdge {
  Index low, high;  // vertices
  Index half_edge;
  double length;
};

std::vector<BoundaryEdge> boundary_edges(const Surface& surface, const std::function<bool(Index, Index)>& divided) {
  const TriangleMesh& mesh = surface.mesh();
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  std::vector<BoundaryEdge> edges;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2 && !divided(edge[0].half_edge / 3, edge[1].half_edge / 3)) return;
    const EdgeUse& use = edge.front();
    edges.push_back({use.low, use.high, use.half_edge, (mesh.vertices[use.high] - mesh.vertices[use.low]).norm()});
  });
  return edges;
}

// An edge of a chain, passed from its low to its high vertex or the other way.
struct Link {
  Index edge;
  bool forward;
};
using Chain = std::vector<Link>;

class Chains {
 public:
  Chains(const std::vector<BoundaryEdge>& edges, std::size_t vertex_count) : edges_(edges), used_(edges.size(), false) {
    at_vertex_.assign(vertex_count, {kNone, kNone});
    degree_.assign(vertex_count, 0);
    for (Index e = 0; e < edges.size(); ++e)
      for (const Index vertex : {edges[e].low, edges[e].high})
        if (degree_[vertex]++ < 2) at_vertex_[vertex][degree_[vertex] - 1] = e;
  }

  // Chains with ends come first, then loops; each begins at its lowest edge.
  std::vector<Chain> collect() {
    std::vector<Chain> chains;
    for (const bool loops : {false, true}) {
      for (Index e = 0; e < edges_.size(); ++e) {
        for (const bool forward : {true, false}) {
          const Index start = forward ? edges_[e].low : edges_[e].high;
          if (used_[e] || (!loops && degree_[start] == 2)) continue;
          chains.push_back(follow({e, forward}));
        }
      }
    }
    return chains;
  }

 private:
  Chain follow(Link link) {
    Chain chain;
    while (link.edge != kNone && !used_[link.edge]) {
      chain.push_back(link);
      used_[link.edge] = true;
      const Index vertex = link.forward ? edges_[link.edge].high : edges_[link.edge].low;
      if (degree_[vertex] != 2) break;
      const auto& [first, second] = at_vertex_[vertex];
      const Index next = first == link.edge ? second : first;
      link = {next, edges_[next].low == vertex};
    }
    return chain;
  }

  const std::vector<BoundaryEdge>& edges_;
  std::vector<bool> used_;
  std::vector<std::array<Index, 2>> at_vertex_;  // the first two boundary edges at each vertex
  std::vector<Index> degree_;
};

void place_on_chain(const TriangleMesh& mesh, const std::vector<BoundaryEdge>& edges, const Chain& chain, Index count,
                    double length, std::vector<EdgePoint>& out) {
  double before = 0;
  std::size_t at = 0;
  for (Index k = 0; k < count; ++k) {
    const double target = length * ((k + 0.5) / count);
    while (at + 1 < chain.size() && before + edges[chain[at].edge].length <= target)
      before += edges[chain[at++].edge].length;
    const auto& [edge, forward] = chain[at];
    const double length_here = edges[edge].length;
    const double along = length_here > 0 ? std::clamp((target - before) / length_here, 0.0, 1.0) : 0.5;
    const Index half_edge = edges[edge].half_edge;
    const bool from_low = mesh.triangles[half_edge / 3][half_edge % 3] == edges[edge].low;
    out.push_back({half_edge / 3, static_cast<int>(half_edge % 3), forward == from_low ? along : 1 - along});
  }
}

}  // namespace

EdgePlacement place_edge_points(const Surface& surface, const std::function<bool(Index, Index)>& divided, Index count,
                                double min_spacing) {
  EdgePlacement placement;
  const std::vector<BoundaryEdge> edges = boundary_edges(surface, divided);
  const std::vector<Chain> chains = Chains(edges, surface.mesh().vertices.size()).collect();
  std::vector<double> lengths;
  double& total = placement.length;
  for (const Chain& chain : chains) {
    double length = 0;
    for (const Link& link : chain) length += edges[link.edge].length;
    lengths.push_back(length);
    total += length;
  }
  if (!(total > 0)) return placement;
  if (count * min_spacing > total) count = static_cast<Index>(total / min_spacing);
  double sum = 0;
  Index placed = 0;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    sum += lengths[c];
    // A point k belongs to this chain if (k + 1/2) / count of the total length is before the end of the chain.
    const bool last = c + 1 == chains.size();
    const auto end =
        last ? count : static_cast<Index>(std::min(std::floor(count * (sum / total) + 0.5), double(count)));
    if (end > placed && lengths[c] > 0)
      place_on_chain(surface.mesh(), edges, chains[c], end - placed, lengths[c], placement.points);
    placed = std::max(placed, end);
  }
  return placement;
}

}  // namespace orchard::detail
