#include "sibling_balance.h"

#include <algorithm>
#include <cmath>

namespace orchard::detail {
namespace {

// A family's looseness is about inversely proportional to this power of its number of spheres: the power is between 1/2
// for flat parts and 1 for long ones.
constexpr double kFall = 0.7;

}  // namespace

std::vector<Index> balanced_counts(const std::vector<Family>& families, double power, Index branching) {
  const Index max = max_children(branching);
  std::vector<Index> counts(families.size(), 0);
  Index left = 0;
  for (std::size_t i = 0; i < families.size(); ++i) {
    left += families[i].spheres;
    if (families[i].spheres == 0) continue;
    // A family that does not use all spheres that it has now cannot use more.
    counts[i] = families[i].spheres < branching ? families[i].spheres : 2;
    left -= counts[i];
  }
  const auto cost = [&](std::size_t i, Index count) {
    return families[i].cost * std::pow(static_cast<double>(families[i].spheres) / count, kFall * power);
  };
  for (; left > 0; --left) {
    std::size_t best = families.size();
    double max_saved = 0;
    for (std::size_t i = 0; i < families.size(); ++i) {
      if (families[i].spheres < branching || counts[i] >= max) continue;
      const double saved = cost(i, counts[i]) - cost(i, counts[i] + 1);
      if (saved > max_saved) max_saved = saved, best = i;
    }
    if (best == families.size()) break;
    ++counts[best];
  }
  return counts;
}

}  // namespace orchard::detail
