#include "join_fins.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace orchard::detail {
namespace {

class FinJoiner {
 public:
  FinJoiner(SheetExtension& sheets, BallSolver& solver, std::span<const Fin> fins)
      : sheets_(sheets), solver_(solver), fins_(fins), joins_(fins.size(), 0) {}

  void run() {
    for (const auto& [length, i, k] : pairs()) {
      if (joins_[i] < kMaxJoins && joins_[k] < kMaxJoins && join(fins_[i], fins_[k])) {
        ++joins_[i];
        ++joins_[k];
      }
    }
  }

 private:
  static constexpr double kMaxLength = 3;  // spacings, between the vertices of two fins
  static constexpr double kNear = 0.3;     // of that: how far the axis may be from the middle
  static constexpr double kMaxDetour = 2;  // of that: the way between the bases
  static constexpr int kMaxJoins = 2;      // of a fin: a ridge has two directions

  const ExactBall& ball(Index v) const { return sheets_.complex.balls[v]; }
  double apart(Index a, Index b) const { return (ball(a).center - ball(b).center).norm(); }

  // Of fins whose vertices are near, the nearest first.
  std::vector<std::tuple<double, Index, Index>> pairs() const {
    std::vector<Index> order(fins_.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto x = [&](Index i) { return ball(fins_[i].vertex).center.x(); };
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return x(a) < x(b); });
    const double reach = kMaxLength * sheets_.options.spacing;
    std::vector<std::tuple<double, Index, Index>> found;
    for (auto i = order.begin(); i != order.end(); ++i) {
      for (auto k = i + 1; k != order.end() && x(*k) - x(*i) <= reach; ++k) {
        const double length = apart(fins_[*i].vertex, fins_[*k].vertex);
        if (length <= reach && length > 0) found.emplace_back(length, std::min(*i, *k), std::max(*i, *k));
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  bool join(const Fin& fin, const Fin& other) {
    if (!is_on_axis(ball(fin.vertex), ball(other.vertex))) return false;
    const std::vector<Index> way = way_between(fin, other);
    if (way.empty()) return false;
    // Each end of the way has the fin's vertex; where these fans meet is where both are as near.
    std::size_t meet = 0;
    while (meet + 1 < way.size() && apart(fin.vertex, way[meet + 1]) < apart(other.vertex, way[meet])) ++meet;
    for (std::size_t i = 0; i < meet; ++i) {
      if (!sheets_.triangles.add(fin.vertex, way[i], way[i + 1])) return false;
    }
    for (std::size_t i = way.size() - 1; i > meet; --i) {
      if (!sheets_.triangles.add(other.vertex, way[i], way[i - 1])) return false;
    }
    return sheets_.triangles.add(fin.vertex, way[meet], other.vertex);
  }

  bool is_on_axis(const ExactBall& a, const ExactBall& b) {
    const double length = (a.center - b.center).norm();
    if (!(a.radius > 0) || !(b.radius > 0)) return false;
    const ExactBall middle = solver_.between(a, b, 0.5);
    return middle.exact && middle.radius > 0 && middle.loss >= sheets_.options.level / 2 &&
           (middle.center - 0.5 * (a.center + b.center)).norm() <= kNear * length;
  }

  // Over old edges, from an end of one base to one of the other; nothing if it is long.
  std::vector<Index> way_between(const Fin& fin, const Fin& other) const {
    struct Reached {
      double length;
      Index from;
    };
    const double limit = kMaxDetour * apart(fin.vertex, other.vertex) + kMaxDetour * sheets_.options.spacing;
    std::map<Index, Reached> reached;
    std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue;
    const auto offer = [&](Index v, double length, Index from) {
      if (length > limit) return;
      const auto [at, is_new] = reached.try_emplace(v, Reached{length, from});
      if (!is_new && at->second.length <= length) return;
      at->second = {length, from};
      queue.emplace(length, v);
    };
    for (const Index v : fin.base) offer(v, 0, kNone);
    while (!queue.empty()) {
      const auto [length, v] = queue.top();
      queue.pop();
      if (length > reached.at(v).length) continue;
      if (v == other.base[0] || v == other.base[1]) {
        std::vector<Index> way;
        for (Index at = v; at != kNone; at = reached.at(at).from) way.push_back(at);
        std::reverse(way.begin(), way.end());
        return way;
      }
      for (const Index e : sheets_.at.edges_at[v]) {
        const Index next = sheets_.other_end(e, v);
        offer(next, length + apart(v, next), v);
      }
    }
    return {};
  }

  SheetExtension& sheets_;
  BallSolver& solver_;
  std::span<const Fin> fins_;
  std::vector<int> joins_;
};

}  // namespace

void join_fins(SheetExtension& sheets, BallSolver& solver, std::span<const Fin> fins) {
  FinJoiner(sheets, solver, fins).run();
}

}  // namespace orchard::detail
