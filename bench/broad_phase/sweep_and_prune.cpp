#include <cmath>

#include "rivals.h"

namespace orchard::bench {
namespace {

class SweepAndPrune final : public Rival {
 public:
  SweepAndPrune(const std::vector<Vec3>& positions, const std::vector<double>& radii)
      : positions_(positions), radii_(radii) {
    Vec3 low = positions[0], high = positions[0];
    for (const Vec3& p : positions) {
      for (std::size_t d = 0; d < 3; ++d) low[d] = std::min(low[d], p[d]), high[d] = std::max(high[d], p[d]);
    }
    for (std::size_t d = 1; d < 3; ++d) axis_ = high[d] - low[d] > high[axis_] - low[axis_] ? d : axis_;
    for (BodyIndex i = 0; i < positions.size(); ++i) order_.push_back({0, i});
    refresh();
    std::sort(order_.begin(), order_.end(), [](const Item& a, const Item& b) { return a.lower < b.lower; });
  }

  void find(std::vector<BodyPair>& pairs) override {
    refresh();
    for (std::size_t k = 1; k < order_.size(); ++k) {  // almost sorted
      const Item item = order_[k];
      std::size_t m = k;
      for (; m > 0 && order_[m - 1].lower > item.lower; --m) order_[m] = order_[m - 1];
      order_[m] = item;
    }
    const std::size_t u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const BodyIndex i = order_[k].body;
      const Vec3& p = positions_[i];
      const double upper = p[axis_] + radii_[i];
      for (std::size_t m = k + 1; m < order_.size() && order_[m].lower <= upper; ++m) {
        const BodyIndex j = order_[m].body;
        const Vec3& q = positions_[j];
        const double reach = radii_[i] + radii_[j], dy = q[u] - p[u], dz = q[v] - p[v];
        if (std::fabs(dy) > reach || std::fabs(dz) > reach) continue;
        const double dx = q[axis_] - p[axis_];
        if (dx * dx + dy * dy + dz * dz <= reach * reach) pairs.push_back({std::min(i, j), std::max(i, j)});
      }
    }
  }

 private:
  struct Item {
    double lower;
    BodyIndex body;
  };
  void refresh() {
    for (Item& item : order_) item.lower = positions_[item.body][axis_] - radii_[item.body];
  }

  const std::vector<Vec3>& positions_;
  const std::vector<double>& radii_;
  std::size_t axis_ = 0;
  std::vector<Item> order_;
};

}  // namespace

std::unique_ptr<Rival> sweep_and_prune(const std::vector<Vec3>& positions, const std::vector<double>& radii) {
  return std::make_unique<SweepAndPrune>(positions, radii);
}

}  // namespace orchard::bench
