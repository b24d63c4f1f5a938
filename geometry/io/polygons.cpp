#include "polygons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// The improvement with which another corner replaces the first: more than rounding, less than any bend that matters.
constexpr double kClearlyBetter = 1e-6;
// Radians by which the angles of a fan around one corner may exceed a whole turn: a few roundings.
constexpr double kWholeTurn = 2 * std::numbers::pi + 1e-9;
// A polygon lies on a line if its width times its length is at most this fraction of its length squared.
constexpr double kOnLine = 1e-12;

// A face's corners in space.
class Polygon {
 public:
  Polygon(std::span<const Index> corners, std::span<const Point> vertices) : corners_(corners), vertices_(vertices) {}
  std::size_t size() const { return corners_.size(); }
  const Point& operator[](std::size_t i) const { return vertices_[corners_[i < size() ? i : i - size()]]; }

 private:
  std::span<const Index> corners_;
  std::span<const Point> vertices_;
};

// Returns the smallest cosine between the normal of the polygon and that of a triangle of the fan around `apex`. A
// triangle without area counts as one at a right angle. Stops once the cosine is at most `enough`.
double agreement(const Polygon& polygon, const Vector& normal, std::size_t apex, double enough) {
  double worst = 1;
  for (std::size_t i = 1; i + 1 < polygon.size() && worst > enough; ++i) {
    const Vector a = polygon[apex + i] - polygon[apex], b = polygon[apex + i + 1] - polygon[apex];
    const Vector cross = a.cross(b);
    const double length = cross.norm();
    worst = std::min(worst, length > 0 ? normal.dot(cross) / length : 0);
  }
  return worst;
}

// Returns Newell's vector: the normal of the best plane of the polygon, with twice the area as its length.
Vector area_of(const Polygon& polygon) {
  Vector area = Vector::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    area += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return area;
}

struct Fan {
  std::size_t apex = 0;
  double agreement = 0;  // 0 if the polygon has no normal
};

// Returns the corner whose fan agrees best with the normal.
Fan best_fan(const Polygon& polygon, const Vector& normal, std::size_t trials) {
  Fan best{.apex = 0, .agreement = agreement(polygon, normal, 0, -1)};
  for (std::size_t apex = 1; apex < std::min(polygon.size(), trials); ++apex) {
    if (best.agreement > 1 - kClearlyBetter) break;
    const double candidate = agreement(polygon, normal, apex, best.agreement);
    if (candidate > best.agreement + kClearlyBetter) best = {.apex = apex, .agreement = candidate};
  }
  return best;
}

// Returns whether the angles of a fan add up to less than a full turn. If its triangles all face the right way, it then
// covers no place twice.
bool within_a_turn(const Polygon& polygon, std::size_t apex) {
  double angle = 0;
  for (std::size_t i = 1; i + 1 < polygon.size() && polygon.size() > 4; ++i) {
    const Vector a = polygon[apex + i] - polygon[apex], b = polygon[apex + i + 1] - polygon[apex];
    angle += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return angle <= kWholeTurn;
}

// Returns whether all corners lie on a line or at one place. Such a polygon has no triangles that could overlap.
bool lies_on_line(const Polygon& polygon) {
  Vector axis = Vector::Zero();
  for (std::size_t i = 1; i < polygon.size(); ++i)
    if (const Vector to = polygon[i] - polygon[0]; to.squaredNorm() > axis.squaredNorm()) axis = to;
  double widest = 0;
  for (std::size_t i = 1; i < polygon.size(); ++i)
    widest = std::max(widest, axis.cross(polygon[i] - polygon[0]).norm());
  return !(widest > kOnLine * axis.squaredNorm());
}

std::vector<Index> without_repetitions(std::span<const Index> corners) {
  std::vector<Index> kept;
  for (const Index corner : corners)
    if (kept.empty() || kept.back() != corner) kept.push_back(corner);
  while (kept.size() > 1 && kept.back() == kept.front()) kept.pop_back();
  return kept;
}

}  // namespace

void FaceCollector::add(std::span<const Index> corners, std::size_t at) {
  if (corners.size() > kNone / 3 - triangles_.size())
    throw InputError("the file has too many triangles for 32-bit indices");
  if (corners.size() > 3) faces_.push_back({triangles_.size(), static_cast<Index>(corners.size()), at});
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) triangles_.push_back({corners[0], corners[i], corners[i + 1]});
}

FaceCollector::Split FaceCollector::finish(std::span<const Point> vertices) && {
  Split split;
  std::vector<Index> corners;
  bool fewer = false;
  for (const auto& [first, count, at] : faces_) {
    corners.assign({triangles_[first][0], triangles_[first][1]});
    corners.reserve(count);
    for (std::size_t i = 0; i + 2 < count; ++i) corners.push_back(triangles_[first + i][2]);
    const Polygon polygon(corners, vertices);
    const Vector area = area_of(polygon), normal = area.normalized();
    const bool has_normal = area.norm() > 0 && normal.allFinite();
    const Fan fan = has_normal ? best_fan(polygon, normal, kTrials) : Fan{};
    if (!(fan.agreement > 0 && within_a_turn(polygon, fan.apex))) {
      const std::vector<Index> distinct = without_repetitions(corners);
      const bool flat = lies_on_line(polygon) || distinct.size() < 3;
      const auto cut = has_normal && !flat ? triangulate_polygon(distinct, vertices, normal) : std::nullopt;
      if (cut && cut->size() <= count - 2) {
        std::fill_n(triangles_.begin() + static_cast<std::ptrdiff_t>(first), count - 2,
                    std::array{kNone, kNone, kNone});
        std::copy(cut->begin(), cut->end(), triangles_.begin() + static_cast<std::ptrdiff_t>(first));
        fewer |= cut->size() < count - 2;
        split.triangulated += distinct.size() > 3 ? 1 : 0;
        continue;
      }
      if (!flat && split.overlapping++ == 0) split.first_overlapping = at;
    }
    for (std::size_t i = 0; i + 2 < count; ++i) {
      triangles_[first + i] = {corners[fan.apex], corners[(fan.apex + i + 1) % count],
                               corners[(fan.apex + i + 2) % count]};
    }
  }
  if (fewer) std::erase_if(triangles_, [](const std::array<Index, 3>& t) { return t[0] == kNone; });
  split.triangles = std::move(triangles_);
  return split;
}

}  // namespace orchard
