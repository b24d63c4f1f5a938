#include "skeleton_arcs.h"

#include <algorithm>
#include <utility>

#include "../axis/incidence.h"

namespace orchard::detail {
namespace {

class ArcTracer {
 public:
  ArcTracer(const std::vector<double>& significance, const std::vector<std::uint8_t>& bare, CurveSkeleton& skeleton)
      : significance_(significance), bare_(bare), skeleton_(skeleton), traced_(skeleton.edges.size(), 0) {
    const Index count = static_cast<Index>(skeleton.vertices.size());
    std::vector<std::array<Index, 2>> pairs;
    for (Index e = 0; e < skeleton.edges.size(); ++e) {
      for (const Index end : skeleton.edges[e]) pairs.push_back({end, e});
    }
    edges_at_ = rows_of(pairs, count);
    on_sheet_.assign(count, 0);
    for (const auto& triangle : skeleton.sheets) {
      for (const Index corner : triangle) on_sheet_[corner] = 1;
    }
  }

  void run() {
    const Index count = static_cast<Index>(skeleton_.vertices.size());
    for (Index vertex = 0; vertex < count; ++vertex) {
      if (!is_node(vertex)) continue;
      skeleton_.nodes.push_back(vertex);
      trace_from(vertex);
    }
    for (Index vertex = 0; vertex < count; ++vertex) {  // closed curves
      const std::size_t before = skeleton_.arcs.size();
      trace_from(vertex);
      if (skeleton_.arcs.size() > before) skeleton_.nodes.push_back(vertex);
    }
    std::sort(skeleton_.nodes.begin(), skeleton_.nodes.end());
  }

 private:
  // Inner vertices of closed sheets are not nodes.
  bool is_node(Index vertex) const {
    const std::size_t curves = edges_at_[vertex].size();
    return on_sheet_[vertex] ? curves > 0 : curves != 2;
  }

  void trace_from(Index start) {
    for (const Index first : edges_at_[start]) {
      if (traced_[first]) continue;
      CurveSkeleton::Arc arc;
      arc.from = start;
      arc.of_axis = true;
      arc.vertices.push_back(start);
      Index edge = first, vertex = start;
      for (;;) {
        traced_[edge] = 1;
        const auto [a, b] = skeleton_.edges[edge];
        arc.length += (skeleton_.vertices[a] - skeleton_.vertices[b]).norm();
        arc.significance = std::max(arc.significance, significance_[edge]);
        arc.of_axis = arc.of_axis && bare_[edge];
        vertex = vertex == a ? b : a;
        arc.vertices.push_back(vertex);
        if (vertex == start || is_node(vertex)) break;
        edge = edges_at_[vertex][0] == edge ? edges_at_[vertex][1] : edges_at_[vertex][0];
      }
      finish(std::move(arc));
    }
  }

  void finish(CurveSkeleton::Arc arc) {
    arc.to = arc.vertices.back();
    arc.min_radius = skeleton_.radii[arc.from];
    for (const Index vertex : arc.vertices) {
      arc.min_radius = std::min(arc.min_radius, skeleton_.radii[vertex]);
      arc.mean_radius += skeleton_.radii[vertex] / static_cast<double>(arc.vertices.size());
    }
    skeleton_.arcs.push_back(std::move(arc));
  }

  const std::vector<double>& significance_;
  const std::vector<std::uint8_t>& bare_;
  CurveSkeleton& skeleton_;
  Rows edges_at_;
  std::vector<std::uint8_t> on_sheet_, traced_;
};

}  // namespace

void trace_arcs(const std::vector<double>& significance, const std::vector<std::uint8_t>& bare,
                CurveSkeleton& skeleton) {
  ArcTracer(significance, bare, skeleton).run();
}

}  // namespace orchard::detail
