#include "workspace/regions.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace orchard::detail {
namespace {

// Normals across the faces, edges and corners of a cube.
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

// The shares of the points that may be on one side of a cut.
constexpr std::array<double, 5> kParts{0.44, 0.47, 0.5, 0.53, 0.56};

// The number of points that wait for a single thread at the end, over the share of vertices that are mixed.
constexpr double kWaitPerMixed = 3;

// The numbers of points and vertices that are sampled to judge a cut.
constexpr std::size_t kPoints = 2048, kVertices = 8192;

// The cost of a cut, and its height along a normal.
struct Offer {
  double cost = std::numeric_limits<double>::infinity(), offset = 0;
};

// Returns the heights below which each of kParts of the points are. Selecting costs a mispredicted branch for every
// second point that is compared. So points beyond all of these parts are first removed, without branches, as far as a
// sample shows.
std::array<double, kParts.size()> heights_of_parts(std::vector<double>& heights) {
  constexpr std::size_t kTried = 256, kMargin = kTried / 8;
  const auto rank = [](double part, std::size_t count) {
    return static_cast<std::size_t>(part * static_cast<double>(count));
  };
  std::size_t below = 0, count = heights.size();
  std::vector<double> middle(heights.size());
  if (heights.size() >= 8 * kTried) {
    std::array<double, kTried> sample;
    for (std::size_t i = 0; i < kTried; ++i) sample[i] = heights[i * (heights.size() / kTried)];
    std::sort(sample.begin(), sample.end());
    const double low = sample[rank(kParts.front(), kTried) - kMargin],
                 high = sample[rank(kParts.back(), kTried) + kMargin];
    count = 0;
    for (const double height : heights) {
      middle[count] = height;
      below += height < low;
      count += std::size_t{height >= low} & std::size_t{height <= high};
    }
  }
  const std::size_t first = rank(kParts.front(), heights.size()), last = rank(kParts.back(), heights.size());
  if (below <= first && last < below + count && count < heights.size())
    middle.resize(count);
  else
    middle = heights, below = 0;
  std::array<double, kParts.size()> result;
  auto sorted = middle.begin();
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    const auto at = middle.begin() + static_cast<std::ptrdiff_t>(rank(kParts[i], heights.size()) - below);
    std::nth_element(sorted, at, middle.end());
    result[i] = *(sorted = at);
  }
  return result;
}

std::vector<Index> some_of(std::span<const Index> all, std::size_t count) {
  std::vector<Index> some;
  for (std::size_t i = 0; i < all.size(); i += all.size() / count + 1) some.push_back(all[i]);
  return some;
}

}  // namespace

// A sample of one part: waiting points, and the forming points of vertices near them.
struct Regions::Sample {
  std::vector<Point> points;
  std::vector<std::array<Point, 4>> vertices;  // the first point again in place of the infinite one

  // Returns the cheapest cut across a normal.
  Offer best_offer(const Vector& normal) const {
    std::vector<double> heights(points.size());
    std::transform(points.begin(), points.end(), heights.begin(), [&](const Point& p) { return normal.dot(p); });
    const std::array<double, kParts.size()> offsets = heights_of_parts(heights);
    std::array<std::size_t, kParts.size()> mixed{};
    for (const auto& [a, b, c, d] : vertices) {
      const double of_a = normal.dot(a), of_b = normal.dot(b), of_c = normal.dot(c), of_d = normal.dot(d);
      const double low = std::min(std::min(of_a, of_b), std::min(of_c, of_d));
      const double high = std::max(std::max(of_a, of_b), std::max(of_c, of_d));
      for (std::size_t i = 0; i < kParts.size(); ++i)
        mixed[i] += std::size_t{low <= offsets[i]} & std::size_t{high > offsets[i]};
    }
    Offer best;
    for (std::size_t i = 0; i < kParts.size(); ++i) {
      const double cost = kWaitPerMixed * static_cast<double>(mixed[i]) / static_cast<double>(vertices.size() + 1) +
                          std::abs(kParts[i] - 0.5);
      if (cost < best.cost) best = {cost, offsets[i]};
    }
    return best;
  }

  // Divides the sample. Vertices that are cut already cost nothing more, so they go to neither half.
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
