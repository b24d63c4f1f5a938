#include "regions.h"

#include <tbb/parallel_for.h>

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

// What a cut costs, at what height along a normal.
struct Offer {
  double cost = std::numeric_limits<double>::infinity(), offset = 0;
};

std::vector<Index> some_of(std::span<const Index> all, std::size_t count) {
  std::vector<Index> some;
  for (std::size_t i = 0; i < all.size(); i += all.size() / count + 1) some.push_back(all[i]);
  return some;
}

}  // namespace

// Of one part: points that wait, and the forming points of vertices near them.
struct Regions::Sample {
  std::vector<Point> points;
  std::vector<std::array<Point, 4>> vertices;  // for the infinite point, the first one again

  // The cheapest cut across a normal.
  Offer best_offer(const Vector& normal) const {
    std::vector<double> heights(points.size());
    std::transform(points.begin(), points.end(), heights.begin(), [&](const Point& p) { return normal.dot(p); });
    std::array<double, kParts.size()> offsets;
    auto sorted = heights.begin();
    for (std::size_t i = 0; i < kParts.size(); ++i) {
      const auto at = heights.begin() + static_cast<std::ptrdiff_t>(kParts[i] * static_cast<double>(heights.size()));
      std::nth_element(sorted, at, heights.end());
      offsets[i] = *(sorted = at);
    }
    std::array<std::size_t, kParts.size()> mixed{};
    for (const auto& [a, b, c, d] : vertices) {
      const double heights_of[] = {normal.dot(a), normal.dot(b), normal.dot(c), normal.dot(d)};
      const auto [low, high] = std::minmax_element(std::begin(heights_of), std::end(heights_of));
      for (std::size_t i = 0; i < kParts.size(); ++i) mixed[i] += *low <= offsets[i] && *high > offsets[i];
    }
    Offer best;
    for (std::size_t i = 0; i < kParts.size(); ++i) {
      const double cost = kWaitPerMixed * static_cast<double>(mixed[i]) / static_cast<double>(vertices.size() + 1) +
                          std::abs(kParts[i] - 0.5);
      if (cost < best.cost) best = {cost, offsets[i]};
    }
    return best;
  }

  // What is cut already costs nothing more: it goes to neither.
  std::array<Sample, 2> halves(const Cut& cut) const {
    std::array<Sample, 2> result;
    for (const Point& p : points) result[cut.is_beyond(p)].points.push_back(p);
    for (const auto& vertex : vertices) {
      const auto beyond = std::count_if(vertex.begin(), vertex.end(), [&](const Point& p) { return cut.is_beyond(p); });
      if (beyond == 0 || beyond == 4) result[beyond == 4].vertices.push_back(vertex);
    }
    return result;
  }
};

Regions::Regions(const Workspace& workspace, std::span<const Index> waiting, std::span<const Index> near,
                 unsigned halvings)
    : halvings_(halvings) {
  std::array<Sample, 2u << kMaxHalvings> samples;
  for (const Index p : some_of(waiting, kPoints << halvings)) samples[1].points.push_back(workspace.points[p]);
  for (const Index v : some_of(near, kVertices << halvings)) {
    const auto& corner = workspace.vertices[v].forming_points;
    const auto point = [&](unsigned i) { return workspace.points[corner[corner[i] == kInfinitePoint ? 0 : i]]; };
    samples[1].vertices.push_back({point(0), point(1), point(2), point(3)});
  }
  for (std::size_t node = 1; node < std::size_t{1} << halvings; ++node) {
    cuts_[node] = best_cut(samples[node]);
    auto [low, high] = samples[node].halves(cuts_[node]);
    samples[2 * node] = std::move(low);
    samples[2 * node + 1] = std::move(high);
    samples[node] = {};
  }
}

Regions::Cut Regions::best_cut(const Sample& sample) {
  if (sample.points.empty()) return {};
  std::array<Offer, kNormals.size()> offers;
  const auto normal = [](std::size_t n) { return Vector(kNormals[n][0], kNormals[n][1], kNormals[n][2]); };
  tbb::parallel_for(std::size_t{0}, offers.size(), [&](std::size_t n) { offers[n] = sample.best_offer(normal(n)); });
  const auto best =
      std::min_element(offers.begin(), offers.end(), [](const Offer& a, const Offer& b) { return a.cost < b.cost; });
  return {normal(static_cast<std::size_t>(best - offers.begin())), best->offset};
}

}  // namespace orchard::detail
