#include "contact_angles.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "downhill.h"
#include "orchard/geometry/angle.h"
#include "orchard/medial/prune.h"

namespace orchard {
namespace {

constexpr std::size_t kMaxFormingPoints = 64;  // the number of forming points of a coalesced centre that are examined

std::span<const Index> looked_at(const MedialAxis& axis, Index vertex) {
  const auto forming = axis.forming_points[vertex];
  return forming.first(std::min(forming.size(), kMaxFormingPoints));
}

class ContactFinder {
 public:
  ContactFinder(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis)
      : sampling_(sampling), axis_(axis), downhill_(surface) {}

  // Pairs are visited from the widest to the narrowest, since for most vertices the contacts of one or two points
  // decide.
  double angle(Index vertex) {
    const Point& from = axis_.centers[vertex];
    const auto forming = looked_at(axis_, vertex);
    pairs_.clear();
    for (std::size_t a = 0; a < forming.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        pairs_.push_back({detail::seen_angle(axis_, from, forming[a], forming[b]), a, b});
      }
    }
    std::sort(pairs_.begin(), pairs_.end(), [](const Pair& x, const Pair& y) { return x.angle > y.angle; });
    contacts_.assign(forming.size(), std::nullopt);
    const auto contact = [&](std::size_t i) -> const Vector& {
      if (!contacts_[i]) contacts_[i] = nearest_downhill(from, forming[i]) - from;
      return *contacts_[i];
    };
    double widest = 0;
    for (const Pair& pair : pairs_) {
      if (pair.angle <= widest) break;
      widest = std::max(widest, std::min(pair.angle, angle_between(contact(pair.a), contact(pair.b))));
    }
    return widest;
  }

 private:
  struct Pair {
    double angle;
    std::size_t a, b;
  };

  Point nearest_downhill(const Point& from, Index point) {
    ClosestPoint place;
    place.position = sampling_.points[point];
    place.triangle = sampling_.triangles[point];
    place.feature = sampling_.features[point];
    return downhill_.descend(from, place).position;
  }

  const SurfaceSampling& sampling_;
  const MedialAxis& axis_;
  detail::Downhill downhill_;
  std::vector<Pair> pairs_;
  std::vector<std::optional<Vector>> contacts_;
};

}  // namespace

double detail::seen_angle(const MedialAxis& axis, const Point& from, Index p, Index q) {
  const double seen = angle_between(axis.points[p] - from, axis.points[q] - from);
  if (axis.turns.empty()) return seen;
  return std::min(seen, angle_between(axis.normals[p], axis.normals[q]) + axis.turns[p] + axis.turns[q]);
}

void detail::find_contact_angles(const Surface& surface, const SurfaceSampling& sampling, MedialAxis& axis) {
  axis.angles.assign(axis.size(), 0);
  tbb::parallel_for(tbb::blocked_range<Index>(0, axis.size(), 256), [&](const tbb::blocked_range<Index>& range) {
    ContactFinder finder(surface, sampling, axis);
    for (Index i = range.begin(); i != range.end(); ++i) axis.angles[i] = finder.angle(i);
  });
}

double separation_angle(const MedialAxis& axis, std::span<const Index> face, const std::array<Index, 2>& points) {
  Point middle = Point::Zero();
  for (const Index vertex : face) middle += axis.centers[vertex];
  middle /= static_cast<double>(face.size());
  double angle = detail::seen_angle(axis, middle, points[0], points[1]);
  if (axis.angles.empty()) return angle;
  double widest = 0;
  for (const Index vertex : face) widest = std::max(widest, axis.angles[vertex]);
  return std::min(angle, widest);
}

std::vector<double> contact_angles(const MedialAxis& axis) {
  if (!axis.angles.empty()) return axis.angles;
  std::vector<double> angles(axis.size(), 0);
  tbb::parallel_for(Index{0}, axis.size(), [&](Index i) {
    const auto forming = looked_at(axis, i);
    for (std::size_t a = 0; a < forming.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        angles[i] = std::max(angles[i], detail::seen_angle(axis, axis.centers[i], forming[a], forming[b]));
      }
    }
  });
  return angles;
}

}  // namespace orchard
