#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "orchard/runtime/contacts.h"

namespace orchard::runtime::detail {

inline constexpr double kSameLine = 1e-9;  // of the points' spread: points nearer to a line count as on it

// Chooses up to four outermost points, as seen along a direction, and returns how many it has chosen; 0 if there are no
// points. each(visit) has to call visit(seen, point) for all points, always in the same order, where `seen` are two
// coordinates across the direction. It is called at most five times, so the points need not be stored.
template <typename Point, typename Each>
std::uint32_t outermost_points(Each&& each, std::array<Point, kMaxContactPoints>& chosen) noexcept {
  using Seen = std::array<double, 2>;
  struct Best {
    double most = -std::numeric_limits<double>::infinity();
    Seen at{};
  };
  const auto best_by = [&](auto&& value, Point& point) {
    Best best;
    each([&](const Seen& at, const Point& offered) {
      const double v = value(at);
      if (v > best.most) best = {v, at}, point = offered;
    });
    return best;
  };
  const auto apart = [](const Seen& p, const Seen& q) {
    return (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]);
  };
  const Best start = best_by([](const Seen&) { return 0; }, chosen[0]);
  if (start.most < 0) return 0;
  const Seen first = best_by([&](const Seen& p) { return apart(p, start.at); }, chosen[0]).at;
  const Best second = best_by([&](const Seen& p) { return apart(p, first); }, chosen[1]);
  std::uint32_t count = 1;
  if (!(second.most > 0)) return count;
  ++count;
  const Seen line = {second.at[0] - first[0], second.at[1] - first[1]};
  for (const double side : {1.0, -1.0}) {
    const auto beside = [&](const Seen& p) {
      return side * (line[0] * (p[1] - first[1]) - line[1] * (p[0] - first[0]));
    };
    Point point{};
    if (best_by(beside, point).most > kSameLine * second.most) chosen[count++] = point;
  }
  return count;
}

}  // namespace orchard::runtime::detail
