#include "collision/least_reaching.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vector_functions.h"

namespace orchard::runtime::detail {
namespace {

bool outside(const Vec3& x, std::span<const Obstacle> obstacles, double size) noexcept {
  return std::all_of(obstacles.begin(), obstacles.end(),
                     [&](const Obstacle& o) { return dot(o.normal, x) >= o.height - kReaches * size; });
}

// The least vectors that reach one, two or three planes.
Vec3 reaching(const Obstacle& p) noexcept { return along({0, 0, 0}, p.normal, p.height); }

Vec3 reaching(const Obstacle& p, const Obstacle& q) noexcept {
  const double c = dot(p.normal, q.normal), det = 1 - c * c;
  if (!(det > 1e-9)) return {};
  const double s = (p.height - c * q.height) / det, t = (q.height - c * p.height) / det;
  return along(along({0, 0, 0}, p.normal, s), q.normal, t);
}

Vec3 reaching(const Obstacle& p, const Obstacle& q, const Obstacle& r) noexcept {
  const Vec3 qr = cross(q.normal, r.normal), rp = cross(r.normal, p.normal), pq = cross(p.normal, q.normal);
  const double det = dot(p.normal, qr);
  if (!(std::fabs(det) > 1e-6)) return {};
  return along(along(along({0, 0, 0}, qr, p.height / det), rp, q.height / det), pq, r.height / det);
}

}  // namespace

Vec3 min_reaching(std::span<const Obstacle> obstacles, double size) noexcept {
  Vec3 best{};
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& x) {
    const double square = dot(x, x);
    if (square > 0 && square < least && outside(x, obstacles, size)) least = square, best = x;
  };
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    offer(reaching(obstacles[i]));
    for (std::size_t j = 0; j < i; ++j) {
      offer(reaching(obstacles[i], obstacles[j]));
      for (std::size_t k = 0; k < j; ++k) offer(reaching(obstacles[i], obstacles[j], obstacles[k]));
    }
  }
  return best;
}

}  // namespace orchard::runtime::detail
