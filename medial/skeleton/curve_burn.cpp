#include "curve_burn.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace orchard::detail {
namespace {

// A sheet counts as a curve if its fire comes from no farther than this fraction of its radius plus an edge, where an
// edge counts for at most the other fraction of the radius.
constexpr double kNarrow = 0.1, kNarrowEdge = 0.25;
constexpr double kLeastRatio = 0.2;  // over SkeletonOptions::ratio
// As a share of the thresholds in the options: ends of curves below it are artefacts of the triangulation.
constexpr double kNoise = 0.5;

// The length of the mean front below which fires meet at a place, and above which a single fire passes.
constexpr double kFiresMeet = 0.3, kFirePasses = 0.7;

class CurveBurner {
 public:
  CurveBurner(const MedialMesh& mesh, const CellIncidence& at, const SheetBurn& burn, const SkeletonOptions& options,
              double diagonal, double edge_length)
      : mesh_(mesh),
        at_(at),
        burn_(burn),
        erosion_(options.erosion * diagonal),
        ratio_(options.ratio),
        edge_length_(edge_length),
        removed_at_(mesh.edges.size(), std::numeric_limits<double>::infinity()),
        last_removed_(mesh.centers.size(), kNone) {}

  PrunedCurves run() {
    burn_all();
    remove_noise();
    while (remove_branches()) {
    }
    restore_ends();
    for (Index edge = 0; edge < mesh_.edges.size(); ++edge)
      result_.significance.push_back(result_.edge_alive[edge] ? significance(edge) : 0);
    return std::move(result_);
  }

 private:
  struct Removal {
    Index edge, end;
  };

  double length(Index edge) const {
    const auto [a, b] = mesh_.edges[edge];
    return (mesh_.centers[a] - mesh_.centers[b]).norm();
  }
  Index other_end(Index edge, Index vertex) const {
    const auto [a, b] = mesh_.edges[edge];
    return a == vertex ? b : a;
  }
  double significance(Index edge) const {
    return std::isnan(burn_.isolated[edge]) ? removed_at_[edge] : removed_at_[edge] - burn_.isolated[edge];
  }
  bool is_bare(Index edge) const { return at_.triangles_at[edge].empty(); }
  bool is_narrow(Index edge) const {
    const auto [a, b] = mesh_.edges[edge];
    const double radius = 0.5 * (mesh_.radii[a] + mesh_.radii[b]);
    return std::max(burn_.vertex_widths[a], burn_.vertex_widths[b]) <=
           kNarrow * radius + std::min(edge_length_, kNarrowEdge * radius);
  }
  bool is_significant(Index edge) const {
    const double gain = significance(edge);
    if (!(gain >= erosion_)) return false;
    if (is_bare(edge) || std::isinf(gain)) return true;
    return gain >= (is_narrow(edge) ? kLeastRatio : ratio_) * removed_at_[edge];
  }

  // Returns how long the fire takes along an edge from its end. Where fires meet head-on, this is the length of the
  // edge. Elsewhere, it is the extent of the edge along the mean front, because fires that meet at an angle have a mean
  // front along the curve on which they meet, while edges of the triangulation zigzag around that curve. Where a single
  // fire passes, it is the time that this fire takes.
  double duration(Index edge, Index end) const {
    const Index inner = other_end(edge, end);
    const Vector front = 0.5 * (burn_.vertex_fronts[end] + burn_.vertex_fronts[inner]);
    const double strength = front.norm();
    const double meets = std::clamp((kFirePasses - strength) / (kFirePasses - kFiresMeet), 0.0, 1.0);
    if (is_bare(edge) || meets == 1) return length(edge);
    const double along = std::max(0.0, (mesh_.centers[inner] - mesh_.centers[end]).dot(front) / strength);
    return meets * length(edge) + (1 - meets) * along;
  }

  std::vector<Index> degrees() const {
    std::vector<Index> degrees(mesh_.centers.size(), 0);
    for (Index edge = 0; edge < mesh_.edges.size(); ++edge) {
      if (!burn_.edge_alive[edge]) continue;
      for (const Index vertex : mesh_.edges[edge]) ++degrees[vertex];
    }
    return degrees;
  }

  // Burns all edges that have a free end, in the order of their times.
  void burn_all() {
    std::vector<Index> degree = degrees();
    std::vector<std::uint8_t> alive = burn_.edge_alive;
    std::vector<double> exposed = burn_.vertex_times;
    using Offer = std::pair<double, Index>;
    std::priority_queue<Offer, std::vector<Offer>, std::greater<>> queue;
    const auto offer = [&](Index vertex) {
      if (degree[vertex] != 1) return;
      const Index edge = only(at_.edges_at[vertex], alive);
      queue.emplace(std::max(burn_.isolated[edge], exposed[vertex] + duration(edge, vertex)), edge);
    };
    for (Index vertex = 0; vertex < mesh_.size(); ++vertex) offer(vertex);
    while (!queue.empty()) {
      const auto [time, edge] = queue.top();
      queue.pop();
      if (!alive[edge]) continue;  // it has burned from its other end
      const auto [a, b] = mesh_.edges[edge];
      const Index end = degree[a] != 1 ? b : degree[b] != 1 ? a : exposed[b] < exposed[a] ? b : a;
      const Index inner = other_end(edge, end);
      alive[edge] = 0;
      --degree[a], --degree[b];
      removed_at_[edge] = time;
      last_removed_[inner] = edge;
      exposed[inner] = std::max(exposed[inner], time);
      order_.push_back({edge, end});
      offer(inner);
    }
  }

  bool is_noise(Index edge) const {
    const double gain = significance(edge);
    return !is_bare(edge) && (gain < kNoise * erosion_ || gain < kNoise * ratio_ * removed_at_[edge]);
  }

  void remove(Index edge, Index end) {
    result_.edge_alive[edge] = result_.vertex_alive[end] = 0;
    --degree_[end], --degree_[other_end(edge, end)];
  }

  void remove_noise() {
    result_.edge_alive = burn_.edge_alive;
    result_.vertex_alive.assign(mesh_.centers.size(), 1);
    degree_ = degrees();
    for (const auto& [edge, end] : order_) {
      if (degree_[end] == 1 && is_noise(edge)) remove(edge, end);
    }
  }

  // Marks the edges from an end of a curve to its next branching if none of them is significant.
  void mark_branch(Index end, std::vector<std::uint8_t>& marked) const {
    std::vector<Index> branch;
    Index edge = only(at_.edges_at[end], result_.edge_alive);
    for (;;) {
      if (is_significant(edge)) return;
      branch.push_back(edge);
      end = other_end(edge, end);
      if (degree_[end] != 2) break;
      for (const Index next : at_.edges_at[end]) {
        if (result_.edge_alive[next] && next != edge) {
          edge = next;
          break;
        }
      }
    }
    for (const Index e : branch) marked[e] = 1;
  }

  // Removes all marked branches at once, so that of equal branches none is mistaken for the end of the curve that they
  // branch from. Returns whether there were any.
  bool remove_branches() {
    std::vector<std::uint8_t> marked(mesh_.edges.size(), 0);
    for (Index vertex = 0; vertex < mesh_.size(); ++vertex) {
      if (result_.vertex_alive[vertex] && degree_[vertex] == 1) mark_branch(vertex, marked);
    }
    bool removed = false;
    for (const auto& [edge, end] : order_) {
      if (!marked[edge] || !result_.edge_alive[edge]) continue;
      remove(edge, end);
      removed = true;
    }
    return removed;
  }

  // Extends the curves that stay to their ends, along the path on which the fire came.
  void restore_ends() {
    std::vector<Index> tips;
    for (Index vertex = 0; vertex < mesh_.size(); ++vertex) {
      if (result_.vertex_alive[vertex] && degree_[vertex] == 1) tips.push_back(vertex);
    }
    for (Index vertex : tips) {
      for (Index edge = last_removed_[vertex]; edge != kNone && !result_.edge_alive[edge] && is_narrow(edge);
           edge = last_removed_[vertex]) {
        vertex = other_end(edge, vertex);
        result_.edge_alive[edge] = result_.vertex_alive[vertex] = 1;
      }
    }
  }

  const MedialMesh& mesh_;
  const CellIncidence& at_;
  const SheetBurn& burn_;
  const double erosion_, ratio_, edge_length_;
  std::vector<double> removed_at_;   // of each edge: when the fire of the curves removed it
  std::vector<Index> last_removed_;  // of each vertex: the last edge over which the fire came
  std::vector<Removal> order_;
  std::vector<Index> degree_;  // of each vertex: the number of its edges in the result
  PrunedCurves result_;
};

}  // namespace

PrunedCurves prune_curves(const MedialMesh& mesh, const CellIncidence& at, const SheetBurn& burn,
                          const SkeletonOptions& options, double diagonal, double edge_length) {
  return CurveBurner(mesh, at, burn, options, diagonal, edge_length).run();
}

}  // namespace orchard::detail
