#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <string>

#include "../axis/incidence.h"
#include "../formats/graphml_text.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/medial/curve_skeleton.h"

namespace orchard {
namespace {

void append_digits(std::string& text, double value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append_coordinates(std::string& text, const Point& at, char between) {
  for (int k = 0; k < 3; ++k) {
    append_digits(text, at[k]);
    if (k < 2) text += between;
  }
}

// Each vertex with its parent; parents come first. Vertices of closed sheets only are left out.
struct Forest {
  std::vector<Index> order, parents;
};

Forest forest_of(const CurveSkeleton& skeleton, const std::vector<std::uint8_t>& cut) {
  const Index count = static_cast<Index>(skeleton.vertices.size());
  std::vector<std::array<Index, 2>> pairs;
  std::vector<std::uint8_t> on_sheet(count, 0);
  for (const auto& triangle : skeleton.sheets) {
    for (const Index corner : triangle) on_sheet[corner] = 1;
  }
  for (Index e = 0; e < skeleton.edges.size(); ++e) {
    const auto [a, b] = skeleton.edges[e];
    if (!cut[e]) pairs.insert(pairs.end(), {{a, b}, {b, a}});
  }
  const Rows neighbors = detail::rows_of(pairs, count);
  std::vector<Index> by_radius(count);
  for (Index i = 0; i < count; ++i) by_radius[i] = i;
  std::stable_sort(by_radius.begin(), by_radius.end(),
                   [&](Index i, Index k) { return skeleton.radii[i] > skeleton.radii[k]; });
  std::vector<std::uint8_t> seen(count, 0);
  Forest forest;
  for (const Index root : by_radius) {
    if (seen[root] || (on_sheet[root] && neighbors[root].empty())) continue;
    std::vector<std::array<Index, 2>> open{{root, kNone}};
    seen[root] = 1;
    while (!open.empty()) {
      const auto [vertex, parent] = open.back();
      open.pop_back();
      forest.order.push_back(vertex);
      forest.parents.push_back(parent);
      for (const Index next : neighbors[vertex]) {
        if (seen[next]) continue;
        seen[next] = 1;
        open.push_back({next, vertex});
      }
    }
  }
  return forest;
}

}  // namespace

std::vector<Index> left_out_of_swc(const CurveSkeleton& skeleton) {
  DisjointSets sets(skeleton.vertices.size());
  std::vector<Index> left_out;
  for (Index e = 0; e < skeleton.edges.size(); ++e) {
    const auto [a, b] = skeleton.edges[e];
    if (sets.root(a) == sets.root(b)) {
      left_out.push_back(e);
    } else {
      sets.unite(a, b);
    }
  }
  return left_out;
}

std::string to_swc(const CurveSkeleton& skeleton) {
  const std::vector<Index> left_out = left_out_of_swc(skeleton);
  std::vector<std::uint8_t> cut(skeleton.edges.size(), 0);
  for (const Index edge : left_out) cut[edge] = 1;
  const Forest forest = forest_of(skeleton, cut);
  std::vector<Index> numbers(skeleton.vertices.size(), 0);
  for (Index i = 0; i < forest.order.size(); ++i) numbers[forest.order[i]] = i + 1;
  std::string text = "# number kind x y z radius parent\n";
  for (const Index edge : left_out) {
    const auto [a, b] = skeleton.edges[edge];
    text += "# left out: " + std::to_string(numbers[a]) + ' ' + std::to_string(numbers[b]) + '\n';
  }
  if (!skeleton.sheets.empty())
    text += "# left out: " + std::to_string(skeleton.sheets.size()) + " triangles of closed sheets\n";
  for (Index i = 0; i < forest.order.size(); ++i) {
    const Index vertex = forest.order[i], parent = forest.parents[i];
    text += std::to_string(i + 1) + " 0 ";
    append_coordinates(text, skeleton.vertices[vertex], ' ');
    text += ' ';
    append_digits(text, skeleton.radii[vertex]);
    text += ' ' + (parent == kNone ? std::string("-1") : std::to_string(numbers[parent])) + '\n';
  }
  return text;
}

std::string to_graphml(const CurveSkeleton& skeleton) {
  constexpr std::array kNumbers{"length", "mean_radius", "min_radius"};
  detail::GraphmlText text("skeleton", kNumbers);
  for (const Index node : skeleton.nodes) text.add_node(skeleton.vertices[node], skeleton.radii[node]);
  const auto number = [&](Index vertex) {
    return static_cast<Index>(std::lower_bound(skeleton.nodes.begin(), skeleton.nodes.end(), vertex) -
                              skeleton.nodes.begin());
  };
  for (const CurveSkeleton::Arc& arc : skeleton.arcs) {
    const std::array numbers{arc.length, arc.mean_radius, arc.min_radius};
    text.add_edge(number(arc.from), number(arc.to), numbers, arc.of_axis ? "curve" : "ridge");
  }
  return text.finished();
}

std::string to_obj(const CurveSkeleton& skeleton) {
  std::string text;
  for (const Point& vertex : skeleton.vertices) {
    text += "v ";
    append_coordinates(text, vertex, ' ');
    text += '\n';
  }
  std::vector<std::uint8_t> used(skeleton.vertices.size(), 0);
  for (const CurveSkeleton::Arc& arc : skeleton.arcs) {
    text += 'l';
    for (const Index vertex : arc.vertices) {
      text += ' ' + std::to_string(vertex + 1);
      used[vertex] = 1;
    }
    text += '\n';
  }
  for (const auto& triangle : skeleton.sheets) {
    text += 'f';
    for (const Index corner : triangle) {
      text += ' ' + std::to_string(corner + 1);
      used[corner] = 1;
    }
    text += '\n';
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) text += "p " + std::to_string(i + 1) + '\n';
  }
  return text;
}

std::string to_csv(const CurveSkeleton& skeleton) {
  std::string text = "arc,position,x,y,z,radius,burn_time\n";
  for (std::size_t i = 0; i < skeleton.arcs.size(); ++i) {
    double position = 0;
    Point last = skeleton.vertices[skeleton.arcs[i].from];
    for (const Index vertex : skeleton.arcs[i].vertices) {
      const Point& at = skeleton.vertices[vertex];
      position += (at - last).norm();
      last = at;
      text += std::to_string(i) + ',';
      append_digits(text, position);
      text += ',';
      append_coordinates(text, at, ',');
      for (const double value : {skeleton.radii[vertex], skeleton.burn_times[vertex]}) {
        text += ',';
        if (value <= std::numeric_limits<double>::max()) append_digits(text, value);
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace orchard
