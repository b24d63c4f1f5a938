#include "join_fins.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "sheet_way.h"

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
    const std::vector<Index> way = way_between(sheets_, fin.base, other.base, apart(fin.vertex, other.vertex));
    return fill_between(sheets_, fin.vertex, other.vertex, way, [](Index, Index, Index) { return true; });
  }

  bool is_on_axis(const ExactBall& a, const ExactBall& b) {
    const double length = (a.center - b.center).norm();
    if (!(a.radius > 0) || !(b.radius > 0)) return false;
    const ExactBall middle = solver_.between(a, b, 0.5);
    return middle.exact && middle.radius > 0 && middle.loss >= sheets_.options.level / 2 &&
           (middle.center - 0.5 * (a.center + b.center)).norm() <= kNear * length;
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
