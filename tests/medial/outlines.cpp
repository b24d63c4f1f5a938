#include "outlines.h"

#include <cstddef>

#include "support/shapes.h"

namespace orchard::test {
namespace {

double turn(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Ear clipping; quadratic, for a dozen corners.
std::vector<std::array<Index, 3>> triangulated(const Outline& outline) {
  std::vector<Index> left;
  for (Index i = 0; i < outline.size(); ++i) left.push_back(i);
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t i = 0; left.size() > 3; i = (i + 1) % left.size()) {
    const Index a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
    bool ear = turn(outline[a], outline[b], outline[c]) > 0;
    for (const Index p : left) {
      if (p == a || p == b || p == c) continue;
      ear = ear && !(turn(outline[a], outline[b], outline[p]) >= 0 && turn(outline[b], outline[c], outline[p]) >= 0 &&
                     turn(outline[c], outline[a], outline[p]) >= 0);
    }
    if (!ear) continue;
    triangles.push_back({a, b, c});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    i = 0;
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace

TriangleMesh extruded(const Outline& outline, double height) { return prism(outline, triangulated(outline), height); }

Outline thin_bridge(double thickness) {
  const double low = 1 - thickness / 2, high = 1 + thickness / 2;
  return {{0, 0}, {1.5, 0}, {1.5, low},  {3.5, low},  {3.5, 0}, {5, 0},
          {5, 2}, {3.5, 2}, {3.5, high}, {1.5, high}, {1.5, 2}, {0, 2}};
}

Outline knees(double gap) {
  const double left = 2 - gap / 2, right = 2 + gap / 2;
  return {{0.5, 0}, {1.1, 0}, {left, 2},          {1.1, 4}, {2.9, 4}, {right, 2},
          {2.9, 0}, {3.5, 0}, {2.6 + gap / 2, 2}, {3.5, 5}, {0.5, 5}, {1.4 - gap / 2, 2}};
}

Outline short_shelf(double gap) {
  return {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 1 + gap}, {1.5, 1 + gap}, {1.5, 2 + gap}, {0, 2 + gap}};
}

Outline two_teeth(double gap) {
  const double top = 2 - gap;
  return {{0, 0},     {5, 0},     {5, 3},   {0, 3},   {0, 2},     {4.5, 2},   {4.5, 1}, {3.5, 1},
          {3.5, top}, {2.5, top}, {2.5, 1}, {1.5, 1}, {1.5, top}, {0.5, top}, {0.5, 1}, {0, 1}};
}

Outline v_groove(double width) {
  return {{0, 0}, {3, 0}, {3, 2}, {1.5 + width / 2, 2}, {1.5, 0.3}, {1.5 - width / 2, 2}, {0, 2}};
}

Outline u_groove(double width) {
  const double left = 1.5 - width / 2, right = 1.5 + width / 2;
  return {{0, 0}, {3, 0}, {3, 2}, {right + width, 2}, {right, 0.3}, {left, 0.3}, {left - width, 2}, {0, 2}};
}

}  // namespace orchard::test
