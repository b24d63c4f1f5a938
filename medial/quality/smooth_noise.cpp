#include "smooth_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

constexpr std::uint64_t kNoiseStage = 0x6e6f69;
// Random directions are drawn in a ball, and shorter vectors are rejected because their direction is imprecise.
constexpr double kTooShort = 0.1;

// Divides a triangle at the middles of those of its edges that have one. Appends the pieces to `out`.
void divide(std::array<Index, 3> corners, std::array<Index, 3> middles, std::vector<std::array<Index, 3>>& out) {
  const auto halved = 3 - std::count(middles.begin(), middles.end(), kNone);
  // Rotates the corners so that the edge that is the only halved one, or the only whole one, comes first.
  const auto is_first = [&](Index middle) { return halved == 1 ? middle != kNone : middle == kNone; };
  if (halved == 1 || halved == 2) {
    const auto first = std::find_if(middles.begin(), middles.end(), is_first) - middles.begin();
    std::rotate(corners.begin(), corners.begin() + first, corners.end());
    std::rotate(middles.begin(), middles.begin() + first, middles.end());
  }
  const auto& [a, b, c] = corners;
  const auto& [ab, bc, ca] = middles;
  switch (halved) {
    case 0:
      out.push_back(corners);
      break;
    case 1:
      out.insert(out.end(), {{a, ab, c}, {ab, b, c}});
      break;
    case 2:
      out.insert(out.end(), {{bc, c, ca}, {a, b, bc}, {a, bc, ca}});
      break;
    default:
      out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {bc, c, ca}, {ab, bc, ca}});
  }
}

}  // namespace

SmoothNoise::SmoothNoise(const Box& box, double spacing, std::uint64_t seed)
    : origin_(box.min()), spacing_(spacing), seed_(seed) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    corners_[axis] = static_cast<std::uint64_t>(box.sizes()[static_cast<Eigen::Index>(axis)] / spacing) + 2;
}

Vector SmoothNoise::operator()(const Point& place) const {
  std::array<std::uint64_t, 3> cell{};
  std::array<double, 3> weight{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    const double along = std::max(0.0, (place[at] - origin_[at]) / spacing_);
    cell[axis] = static_cast<std::uint64_t>(along);
    const double t = along - static_cast<double>(cell[axis]);
    weight[axis] = t * t * (3 - 2 * t);
  }
  Vector sum = Vector::Zero();
  for (unsigned corner = 0; corner < 8; ++corner) {
    double share = 1;
    std::uint64_t number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis & 1u) != 0;
      share *= upper ? weight[axis] : 1 - weight[axis];
      number = number * corners_[axis] + cell[axis] + (upper ? 1 : 0);
    }
    sum += share * direction(number);
  }
  return sum;
}

Vector SmoothNoise::direction(std::uint64_t corner) const {
  Random random(seed_, kNoiseStage, corner);
  for (;;) {
    // The numbers are drawn in separate statements, because the order in which arguments are evaluated depends on the
    // compiler.
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const Vector way(x, y, z);
    const double length = way.norm();
    if (length <= 1 && length > kTooShort) return way / length;
  }
}

TriangleMesh with_short_edges(TriangleMesh mesh, double max) {
  for (;;) {
    std::map<std::pair<Index, Index>, Index> middles;  // the middles of edges that are too long
    const auto middle = [&](Index a, Index b) {
      const Point p = mesh.vertices[a], q = mesh.vertices[b];
      if ((p - q).norm() <= max) return kNone;
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(p + 0.5 * (q - p));
      return at->second;
    };
    std::vector<std::array<Index, 3>> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const std::array<Index, 3>& corners : mesh.triangles) {
      const auto& [a, b, c] = corners;
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      divide(corners, {ab, bc, ca}, triangles);
    }
    mesh.triangles = std::move(triangles);
    if (middles.empty()) return mesh;
  }
}

}  // namespace orchard::detail
