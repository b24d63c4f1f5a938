#include "curve_burn.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace orchard::detail {
namespace {

// Edges: the significance that the triangulation alone can cause.
constexpr double kResolution = 3;
// Of the significance that is asked for: the least part that a curve itself has to gain from its end on. The rest may
// come from where it ends.
constexpr double kOwn = 0.7;
// Where no branch is significant yet, the largest one is taken for the end of the curve. If another one is at least as
// long as the first fraction of it, of its significance the second fraction has to be beyond what the ratio asks for:
// so none of the ridges that come to the tip of a cone or into the corners of a plate is taken for the end.
constexpr double kRival = 0.5, kSure = 0.25;

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
        removed_at_(mesh.edges.size(), std::numeric_limits<double>::infinity()) {}

  PrunedCurves run() {
    burn_all();
    find_ends();
    remove_ends();
    for (Index edge = 0; edge < mesh_.edges.size(); ++edge)
      result_.significance.push_back(result_.edge_alive[edge] ? significance(edge) : 0);
    return std::move(result_);
  }

 private:
  struct Removal {
    Index edge, end;
  };
  // The end of a curve up to some place of it.
  struct End {
    double reach = 0;          // the length of the longest way to it from where a fire of curves began
    double gain = 0;           // its significance there
    double surplus = 0;        // beyond what the options' ratio asks of its length; the end is where this was least
    bool of_axis = false;      // whether the last edge is a curve of the axis
    bool significant = false;  // whether both were enough at some place before
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
      exposed[inner] = std::max(exposed[inner], time);
      order_.push_back({edge, end});
      offer(inner);
    }
  }

  // By how much the times of the fire of the sheets differ along an edge; on curves of the axis, the radii.
  double delay(Index edge) const {
    const std::vector<double>& times = is_bare(edge) ? mesh_.radii : burn_.vertex_times;
    const auto [a, b] = mesh_.edges[edge];
    return std::abs(times[a] - times[b]);
  }

  // What an edge adds to the end of a curve. The surplus starts again where it is used up: up to there, the fire of the
  // sheets runs along with the curve rather than across it. It also starts again where a curve of the axis begins.
  End extended(End end, Index edge, Index from) const {
    if (end.significant) return end;
    const double own = duration(edge, from), gain = std::max(0.0, own - delay(edge)), reach = end.reach + own;
    if (is_bare(edge) && !end.of_axis) end = {.of_axis = true};
    end.reach = reach;
    end.gain += gain;
    end.surplus += gain - ratio_ * own;
    end.of_axis = is_bare(edge);
    if (!(end.surplus > 0)) return {.reach = reach, .of_axis = end.of_axis};
    end.significant =
        significance(edge) >= ratio_ * removed_at_[edge] && is_long(end.gain) && end.gain >= own_part(edge);
    return end;
  }
  bool is_long(double gain) const { return gain >= std::max(erosion_, kResolution * edge_length_); }
  double own_part(Index edge) const { return kOwn * ratio_ * removed_at_[edge]; }

  // Keeps the significant ones of the curves that come to a vertex; where there is none, at most one. Returns the state
  // of what is kept.
  End joined(std::vector<std::pair<Index, End>>& ends) {
    if (ends.empty()) return {};
    if (std::any_of(ends.begin(), ends.end(), [](const auto& end) { return end.second.significant; })) {
      for (const auto& [edge, end] : ends) stays_[edge] = end.significant;
      return {.significant = true};
    }
    sort_by_gain(ends);
    auto [edge, largest] = ends.front();
    bool has_rival = false;
    const double own_reach = largest.reach;
    for (std::size_t i = 1; i < ends.size(); ++i) {
      has_rival = has_rival || !(ends[i].second.reach < kRival * own_reach);
      largest.reach = std::max(largest.reach, ends[i].second.reach);
    }
    if (!(largest.surplus > (has_rival ? kSure * largest.gain : 0))) return {.reach = largest.reach};
    stays_[edge] = 1;
    return largest;
  }
  static void sort_by_gain(std::vector<std::pair<Index, End>>& ends) {
    std::stable_sort(ends.begin(), ends.end(),
                     [](const auto& a, const auto& b) { return a.second.gain > b.second.gain; });
  }

  // The place of a tree that burns last is within a curve, so that two ends of one curve meet there.
  void join_last(std::vector<std::pair<Index, End>>& ends) {
    std::vector<std::pair<Index, End>> others;
    std::size_t significant = 0;
    for (const auto& [edge, end] : ends) {
      stays_[edge] = end.significant;
      significant += end.significant ? 1 : 0;
      if (!end.significant && end.surplus > 0) others.emplace_back(edge, end);
    }
    const std::size_t missing = significant < 2 ? 2 - significant : 0;
    if (others.size() < missing || missing == 0) return;
    sort_by_gain(others);
    const auto& [edge, end] = others[missing - 1];
    if (others.size() > missing && !(others[missing].second.gain < kRival * end.gain)) return;
    const double both = missing == 2 ? others[0].second.gain + end.gain : end.gain;
    if (!is_long(both) || (missing == 2 && both < own_part(edge))) return;
    for (std::size_t i = 0; i < missing; ++i) stays_[others[i].first] = 1;
  }

  // From the ends inward, in the order in which they burn.
  void find_ends() {
    std::vector<std::vector<std::pair<Index, End>>> coming(mesh_.centers.size());
    stays_.assign(mesh_.edges.size(), 0);
    next_.assign(mesh_.centers.size(), kNone);
    for (const auto& [edge, end] : order_) {
      next_[end] = edge;
      coming[other_end(edge, end)].emplace_back(edge, extended(joined(coming[end]), edge, end));
    }
    for (Index vertex = 0; vertex < mesh_.size(); ++vertex) {
      if (next_[vertex] != kNone) continue;
      if (is_burned(vertex)) {
        join_last(coming[vertex]);
      } else {
        for (const auto& [edge, end] : coming[vertex]) stays_[edge] = end.significant;
      }
    }
  }
  bool is_burned(Index vertex) const {
    return std::all_of(at_.edges_at[vertex].begin(), at_.edges_at[vertex].end(),
                       [&](Index edge) { return !burn_.edge_alive[edge] || std::isfinite(removed_at_[edge]); });
  }

  // An edge stays if the one does that burns after it.
  void remove_ends() {
    result_.edge_alive = burn_.edge_alive;
    result_.vertex_alive.assign(mesh_.centers.size(), 1);
    for (auto removal = order_.rbegin(); removal != order_.rend(); ++removal) {
      const Index next = next_[other_end(removal->edge, removal->end)];
      if (stays_[removal->edge] && (next == kNone || result_.edge_alive[next])) continue;
      result_.edge_alive[removal->edge] = result_.vertex_alive[removal->end] = 0;
    }
  }

  const MedialMesh& mesh_;
  const CellIncidence& at_;
  const SheetBurn& burn_;
  const double erosion_, ratio_, edge_length_;
  std::vector<double> removed_at_;  // of each edge, by the fire of curves
  std::vector<Removal> order_;
  std::vector<std::uint8_t> stays_;  // of each edge: whether its branch does where it joins others
  std::vector<Index> next_;          // the edge over which the fire left each vertex
  PrunedCurves result_;
};

}  // namespace

PrunedCurves prune_curves(const MedialMesh& mesh, const CellIncidence& at, const SheetBurn& burn,
                          const SkeletonOptions& options, double diagonal, double edge_length) {
  return CurveBurner(mesh, at, burn, options, diagonal, edge_length).run();
}

}  // namespace orchard::detail
