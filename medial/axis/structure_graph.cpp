#include <algorithm>
#include <array>
#include <utility>

#include "../formats/graphml_text.h"
#include "axis_complex.h"
#include "orchard/medial/segments.h"

namespace orchard {
namespace {

using Kind = StructureGraph::Kind;

class Tracer {
 public:
  explicit Tracer(const MedialAxis& axis) : axis_(axis), complex_(axis) {
    lines_.resize(axis.size());
    for (Index edge = 0; edge < complex_.edges().size(); ++edge) {
      if (complex_.faces_at(edge).size() == 2) continue;
      for (const Index vertex : complex_.edges()[edge]) lines_[vertex].push_back(edge);
    }
    traced_.assign(complex_.edges().size(), 0);
  }

  StructureGraph run() {
    for (Index vertex = 0; vertex < axis_.size(); ++vertex) {
      if (is_node(vertex)) trace_from(vertex);
    }
    for (Index vertex = 0; vertex < axis_.size(); ++vertex) trace_from(vertex);  // closed lines
    std::sort(graph_.nodes.begin(), graph_.nodes.end());
    graph_.nodes.erase(std::unique(graph_.nodes.begin(), graph_.nodes.end()), graph_.nodes.end());
    for (StructureGraph::Arc& arc : graph_.arcs) {
      arc.from = number(arc.vertices.front());
      arc.to = number(arc.vertices.back());
    }
    return std::move(graph_);
  }

 private:
  Kind kind(Index edge) const {
    const std::size_t faces = complex_.faces_at(edge).size();
    return faces == 0 ? Kind::curve : faces == 1 ? Kind::border : Kind::seam;
  }
  bool is_node(Index vertex) const {
    const auto& lines = lines_[vertex];
    return !lines.empty() && (lines.size() != 2 || kind(lines[0]) != kind(lines[1]));
  }
  Index number(Index vertex) const {
    return static_cast<Index>(std::lower_bound(graph_.nodes.begin(), graph_.nodes.end(), vertex) -
                              graph_.nodes.begin());
  }

  void trace_from(Index start) {
    for (const Index first : lines_[start]) {
      if (traced_[first]) continue;
      StructureGraph::Arc arc;
      arc.kind = kind(first);
      arc.vertices.push_back(start);
      Index edge = first, vertex = start;
      for (;;) {
        traced_[edge] = 1;
        const auto [a, b] = complex_.edges()[edge];
        arc.length += (axis_.centers[a] - axis_.centers[b]).norm();
        vertex = vertex == a ? b : a;
        arc.vertices.push_back(vertex);
        if (vertex == start || is_node(vertex)) break;
        edge = lines_[vertex][0] == edge ? lines_[vertex][1] : lines_[vertex][0];
      }
      for (const Index v : arc.vertices) arc.mean_radius += axis_.radii[v] / static_cast<double>(arc.vertices.size());
      graph_.nodes.push_back(start);
      graph_.nodes.push_back(vertex);
      graph_.arcs.push_back(std::move(arc));
    }
  }

  const MedialAxis& axis_;
  detail::AxisComplex complex_;
  std::vector<std::vector<Index>> lines_;  // edges that are not within a sheet, of each vertex
  std::vector<std::uint8_t> traced_;
  StructureGraph graph_;
};

}  // namespace

StructureGraph structure_graph(const MedialAxis& axis) { return Tracer(axis).run(); }

std::string to_graphml(const StructureGraph& graph, const MedialAxis& axis) {
  constexpr std::array kNumbers{"length", "mean_radius"};
  constexpr std::array kNames{"curve", "border", "seam"};
  detail::GraphmlText text("structure", kNumbers);
  for (const Index vertex : graph.nodes) text.add_node(axis.centers[vertex], axis.radii[vertex]);
  for (const StructureGraph::Arc& arc : graph.arcs) {
    const std::array numbers{arc.length, arc.mean_radius};
    text.add_edge(arc.from, arc.to, numbers, kNames[static_cast<std::size_t>(arc.kind)]);
  }
  return text.finished();
}

}  // namespace orchard
