#include "polygons.h"

#include <algorithm>
#include <utility>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// How much better another corner must be before it replaces the first: above rounding, below any bend worth minding.
constexpr double kClearlyBetter = 1e-6;

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

// The smallest cosine between the polygon's normal and a triangle of the fan around `apex`; a triangle without area is
// as bad as one at a right angle. Stops where it falls to `enough` or below.
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

// The corner whose fan agrees best with Newell's normal of the polygon.
std::size_t best_apex(const Polygon& polygon, std::size_t trials) {
  Vector normal = Vector::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    normal += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  const double length = normal.norm();
  if (!(length > 0)) return 0;
  normal /= length;
  std::size_t best = 0;
  double best_agreement = agreement(polygon, normal, 0, -1);
  for (std::size_t apex = 1; apex < std::min(polygon.size(), trials); ++apex) {
    if (best_agreement > 1 - kClearlyBetter) break;
    const double candidate = agreement(polygon, normal, apex, best_agreement);
    if (candidate > best_agreement + kClearlyBetter) best = apex, best_agreement = candidate;
  }
  return best;
}

}  // namespace

void FaceCollector::add(std::span<const Index> corners) {
  if (corners.size() > kNone / 3 - triangles_.size())
    throw InputError("the file has too many triangles for 32-bit indices");
  if (corners.size() > 3) faces_.push_back({triangles_.size(), static_cast<Index>(corners.size())});
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) triangles_.push_back({corners[0], corners[i], corners[i + 1]});
}

std::vector<std::array<Index, 3>> FaceCollector::finish(std::span<const Point> vertices) && {
  std::vector<Index> corners;
  for (const auto& [first, count] : faces_) {
    corners.assign({triangles_[first][0], triangles_[first][1]});
    corners.reserve(count);
    for (std::size_t i = 0; i + 2 < count; ++i) corners.push_back(triangles_[first + i][2]);
    const std::size_t apex = best_apex(Polygon(corners, vertices), kTrials);
    for (std::size_t i = 0; i + 2 < count; ++i) {
      triangles_[first + i] = {corners[apex], corners[(apex + i + 1) % count], corners[(apex + i + 2) % count]};
    }
  }
  return std::move(triangles_);
}

}  // namespace orchard
