#include "regions.h"

#include <algorithm>
#include <cmath>

namespace orchard::detail {
namespace {

// Across the faces, edges and corners of a cube.
constexpr std::array<std::array<int, 3>, 13> kNormals{{{1, 0, 0},
                                                       {0, 1, 0},
                                                       {0, 0, 1},
                                                       {1, 1, 0},
                                                       {1, -1, 0},
                                                       {1, 0, 1},
                                                       {1, 0, -1},
                                                       {0, 1, 1},
                                                       {0, 1, -1},
                                                       {1, 1, 1},
                                                       {1, 1, -1},
                                                       {1, -1, 1},
                                                       {-1, 1, 1}}};

// Which part of the points may be on one side.
constexpr std::array<double, 5> kParts{0.44, 0.47, 0.5, 0.53, 0.56};

// How many points wait for one thread in the end, in terms of the part of the vertices that is mixed.
constexpr double kWaitPerMixed = 3;

constexpr std::size_t kPoints = 2048, kVertices = 8192;  // to judge a cut by

std::vector<Index> sample(std::span<const Index> all, std::size_t count) {
  std::vector<Index> some;
  for (std::size_t i = 0; i < all.size(); i += all.size() / count + 1) some.push_back(all[i]);
  return some;
}

}  // namespace

Regions::Regions(const Workspace& workspace, std::span<const Index> waiting, std::span<const Index> near,
                 unsigned halvings)
    : halvings_(halvings) {
  struct Part {
    std::vector<Index> points, vertices;
  };
  std::array<Part, 2u << kMaxHalvings> parts;
  parts[1] = {sample(waiting, kPoints << halvings), sample(near, kVertices << halvings)};
  for (std::size_t node = 1; node < std::size_t{1} << halvings; ++node) {
    const Cut cut = cuts_[node] = best_cut(workspace, parts[node].points, parts[node].vertices);
    Part &low = parts[2 * node], &high = parts[2 * node + 1];
    for (const Index p : parts[node].points) (cut.is_beyond(workspace.points[p]) ? high : low).points.push_back(p);
    // What is cut already costs nothing more.
    for (const Index v : parts[node].vertices) {
      const auto& corner = workspace.vertices[v].forming_points;
      const auto is_beyond = [&](Index p) { return p != kInfinitePoint && cut.is_beyond(workspace.points[p]); };
      const auto is_below = [&](Index p) { return p != kInfinitePoint && !cut.is_beyond(workspace.points[p]); };
      if (std::none_of(corner.begin(), corner.end(), is_beyond)) low.vertices.push_back(v);
      if (std::none_of(corner.begin(), corner.end(), is_below)) high.vertices.push_back(v);
    }
    parts[node] = {};
  }
}

Regions::Cut Regions::best_cut(const Workspace& workspace, std::span<const Index> waiting,
                               std::span<const Index> near) const {
  Cut best;
  double best_cost = std::numeric_limits<double>::infinity();
  std::vector<double> heights(waiting.size());
  std::vector<std::array<double, 2>> spans(near.size());  // of the forming points' heights
  for (const auto& [x, y, z] : kNormals) {
    if (waiting.empty()) break;
    const Vector normal(x, y, z);
    std::transform(waiting.begin(), waiting.end(), heights.begin(),
                   [&](Index p) { return normal.dot(workspace.points[p]); });
    std::sort(heights.begin(), heights.end());
    for (std::size_t i = 0; i < near.size(); ++i) {
      spans[i] = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
      for (const Index p : workspace.vertices[near[i]].forming_points) {
        if (p == kInfinitePoint) continue;
        const double height = normal.dot(workspace.points[p]);
        spans[i] = {std::min(spans[i][0], height), std::max(spans[i][1], height)};
      }
    }
    for (const double part : kParts) {
      const double offset = heights[static_cast<std::size_t>(part * static_cast<double>(heights.size()))];
      const auto mixed = static_cast<double>(std::count_if(
          spans.begin(), spans.end(), [&](const auto& span) { return span[0] <= offset && span[1] > offset; }));
      const double cost = kWaitPerMixed * mixed / static_cast<double>(near.size() + 1) + std::abs(part - 0.5);
      if (cost < best_cost) best = {normal, offset}, best_cost = cost;
    }
  }
  return best;
}

}  // namespace orchard::detail
