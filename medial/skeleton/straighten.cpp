#include "straighten.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "../axis/incidence.h"

namespace orchard::detail {
namespace {

// Taubin's factors: a step towards the middle of the neighbours, and one away from it.
constexpr double kTaubinShrink = 0.5, kTaubinGrow = -0.53;
constexpr double kChordAccuracy = 0.02;  // of `limit`: the accuracy to which the distance of chords is bounded
constexpr int kMaxChordHalvings = 100'000;

class Straightener {
 public:
  Straightener(CurveGraph& graph, const Surface& surface, const Surface& sheets, double limit)
      : graph_(graph), sheets_(sheets), limit_(limit), start_(graph.vertices) {
    std::vector<std::array<Index, 2>> pairs;
    for (const auto& [a, b] : graph.edges) pairs.insert(pairs.end(), {{a, b}, {b, a}});
    neighbors_ = rows_of(pairs, static_cast<Index>(graph.vertices.size()));
    find_room(surface);
  }

  void round() {
    step(kTaubinShrink);
    step(kTaubinGrow);
    for (Index i = 0; i < start_.size(); ++i) {
      if (!(room_[i] > 0)) continue;
      const ClosestPoint nearest = sheets_.closest_within(graph_.vertices[i], limit_);
      if (nearest.triangle != kNone && (nearest.position - start_[i]).norm() <= room_[i])
        last_good_[i] = nearest.position;
      graph_.vertices[i] = last_good_[i];
    }
  }

  Straightened measure() const {
    Straightened result;
    for (Index i = 0; i < start_.size(); ++i)
      result.max_moved = std::max(result.max_moved, (graph_.vertices[i] - start_[i]).norm());
    result.axis_distance = chord_distance();
    return result;
  }

 private:
  void find_room(const Surface& surface) {
    std::vector<double> radii(start_.size(), 0);
    for (Index i = 0; i < start_.size(); ++i) radii[i] = std::max(0.0, -surface.signed_distance(start_[i]));
    room_.assign(start_.size(), limit_);
    for (const auto& [a, b] : graph_.edges) {
      const double bound = 0.5 * (radii[a] + radii[b] - (start_[a] - start_[b]).norm());
      for (const Index end : {a, b}) room_[end] = std::min(room_[end], bound * (1 - 1e-9));
    }
    for (Index i = 0; i < start_.size(); ++i) {
      if (graph_.fixed[i] || neighbors_[i].empty()) room_[i] = 0;
    }
    last_good_ = start_;
  }

  void step(double factor) {
    std::vector<Point> next = graph_.vertices;
    for (Index i = 0; i < next.size(); ++i) {
      if (!(room_[i] > 0)) continue;
      Point middle = Point::Zero();
      for (const Index neighbor : neighbors_[i]) middle += graph_.vertices[neighbor];
      middle /= static_cast<double>(neighbors_[i].size());
      next[i] += factor * (middle - graph_.vertices[i]);
    }
    graph_.vertices = std::move(next);
  }

  // Bounds the distance by halving segments, those with the largest bounds first, since the distance is 1-Lipschitz.
  double chord_distance() const {
    struct Segment {
      double upper = 0;
      Point a = Point::Zero(), b = Point::Zero();
      bool operator<(const Segment& other) const { return upper < other.upper; }
    };
    std::priority_queue<Segment> queue;
    double lower = 0;
    const auto add = [&](const Point& a, const Point& b) {
      const double distance = sheets_.distance(0.5 * (a + b));
      lower = std::max(lower, distance);
      queue.push({distance + 0.5 * (b - a).norm(), a, b});
    };
    for (const auto& [a, b] : graph_.edges) {
      if (graph_.vertices[a] != start_[a] || graph_.vertices[b] != start_[b])
        add(graph_.vertices[a], graph_.vertices[b]);
    }
    for (int i = 0; i < kMaxChordHalvings && !queue.empty() && queue.top().upper > lower + kChordAccuracy * limit_;
         ++i) {
      const Segment segment = queue.top();
      queue.pop();
      const Point middle = 0.5 * (segment.a + segment.b);
      add(segment.a, middle);
      add(middle, segment.b);
    }
    return queue.empty() ? 0 : queue.top().upper;
  }

  CurveGraph& graph_;
  const Surface& sheets_;
  const double limit_;
  const std::vector<Point> start_;
  std::vector<Point> last_good_;
  Rows neighbors_;
  std::vector<double> room_;  // of each vertex: how far it may be from where it started
};

}  // namespace

Straightened straighten(CurveGraph& graph, const Surface& surface, const Surface& sheets, double limit, int rounds) {
  Straightener straightener(graph, surface, sheets, limit);
  for (int i = 0; i < rounds; ++i) straightener.round();
  return straightener.measure();
}

}  // namespace orchard::detail
