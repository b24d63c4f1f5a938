#include "orchard/covering/inaccuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "half_angle.h"
#include "interior_surface.h"
#include "search_limits.h"

namespace orchard {
namespace {

// A spherical triangle of directions, with an upper bound on the signed distance over the part of the sphere's surface
// that lies in these directions from its centre.
struct SphericalTriangle {
  double upper;
  std::array<Vector, 3> corners;
  std::array<Point, 2> known;  // of the surface: nearest to the middle, and to that of a larger cell

  static bool less_promising(const SphericalTriangle& a, const SphericalTriangle& b) { return a.upper < b.upper; }
};

// Best-first branch and bound. Let p be the sphere's point in the middle direction of a cell, and q any point of the
// cap around p that the cell's corners span. The signed distance sd at q is at most
//   sd(p) + |q - p|, since sd is 1-Lipschitz;
//   |q - y| for any point y of the surface, such as the ones nearest to p and to the sphere's centre; and
//   sqrt((1 - t) |q - y|^2 + t |q - z|^2) for any two points y and z of the surface, and t from 0 to 1.
// The greatest value of each over the cap bounds the cell. Parts of the surface inside the solid do not count as its
// border (interior_surface.h).
class SphereSearch {
 public:
  SphereSearch(const Surface& surface, const Sphere& sphere, const DistanceTolerance& tolerance)
      : surface_(surface),
        interior_(surface),
        sphere_(sphere),
        radius_(surface.bounding_radius()),
        tolerance_(tolerance) {}

  Bounds run() {
    ClosestPoint nearest;
    const double center_distance = surface_.signed_distance(sphere_.center, nearest);
    const double everywhere = distance_bound(center_distance, sphere_.radius);
    if (everywhere <= 0 || sphere_.radius <= 0) return {0, std::max(0.0, everywhere)};
    anchor_ = nearest.position;
    upper_everywhere_ = everywhere;
    probe_beyond_nearest(center_distance);
    if (everywhere <= best_ + width()) return {best_, everywhere};
    for (const auto& face : octahedron()) evaluate(face, {anchor_, anchor_});
    while (!cells_.empty() && evaluations_ < detail::kMaxEvaluations) {
      if (cells_.front().upper <= best_ + width()) break;
      std::pop_heap(cells_.begin(), cells_.end(), SphericalTriangle::less_promising);
      const SphericalTriangle cell = cells_.back();
      cells_.pop_back();
      split(cell.corners, cell.known);
    }
    const double open = cells_.empty() ? 0 : cells_.front().upper;
    return {best_, std::min(everywhere, std::max({best_, dropped_, open}))};
  }

 private:
  // How far apart the bounds may be at the end, given the lower one.
  double width() const {
    return std::max({tolerance_.of_radius * radius_, tolerance_.of_distance * best_, detail::kFinest * radius_});
  }

  // Measures the sphere's point in the direction of the surface point that is nearest to the centre; for a centre
  // outside, the point opposite to it. Where nothing else of the solid is near, that is the farthest point, and its
  // distance equals the bound that holds everywhere.
  void probe_beyond_nearest(double center_distance) {
    const Vector towards = anchor_ - sphere_.center;
    const double length = towards.norm();
    if (!(length > 0)) return;
    const double way = (center_distance < 0 ? sphere_.radius : -sphere_.radius) / length;
    best_ = std::max(best_, surface_.signed_distance(sphere_.center + way * towards));
    ++evaluations_;
  }

  static std::vector<std::array<Vector, 3>> octahedron() {
    std::vector<std::array<Vector, 3>> faces;
    faces.reserve(8);
    for (int sign = 0; sign < 8; ++sign)
      faces.push_back(
          {Vector((sign & 1) ? 1 : -1, 0, 0), Vector(0, (sign & 2) ? 1 : -1, 0), Vector(0, 0, (sign & 4) ? 1 : -1)});
    return faces;
  }

  void split(const std::array<Vector, 3>& c, const std::array<Point, 2>& known) {
    const Vector ab = (c[0] + c[1]).normalized(), bc = (c[1] + c[2]).normalized(), ca = (c[2] + c[0]).normalized();
    evaluate({c[0], ab, ca}, known);
    evaluate({c[1], bc, ab}, known);
    evaluate({c[2], ca, bc}, known);
    evaluate({ab, bc, ca}, known);
  }

  // `known`: points of the surface whose bounds often show, without a query, that the cell does not matter.
  void evaluate(const std::array<Vector, 3>& corners, const std::array<Point, 2>& known) {
    const Vector middle = (corners[0] + corners[1] + corners[2]).normalized();
    double chord = 0;
    for (const Vector& corner : corners) chord = std::max(chord, (corner - middle).norm());
    const double by_known = std::min(
        {farthest(known[0], middle, chord), farthest_of_both(known[0], known[1], middle, chord), upper_everywhere_});
    if (does_not_matter(by_known * (1 + 1e-12))) return;
    ++evaluations_;
    ClosestPoint nearest;
    const double value = surface_.signed_distance(sphere_.center + sphere_.radius * middle, nearest);
    best_ = std::max(best_, value);
    const Point& here = nearest.position;
    const double upper =
        std::min({value + sphere_.radius * chord, farthest(here, middle, chord),
                  farthest_of_both(here, known[0], middle, chord), farthest(anchor_, middle, chord), by_known}) *
        (1 + 1e-12);
    if (does_not_matter(upper)) return;
    if (value <= interior_.depth() &&
        interior_.fill({sphere_.center + sphere_.radius * middle, sphere_.radius * chord}) &&
        does_not_matter(interior_.depth()))
      return;
    push({upper, corners, {here, known[0]}});
  }

  // Whether a cell with this bound cannot matter and may be dropped. Its bound still counts in the answer's upper
  // bound.
  bool does_not_matter(double upper) {
    if (upper > best_ + 0.5 * width()) return false;
    dropped_ = std::max(dropped_, upper);
    return true;
  }

  void push(const SphericalTriangle& cell) {
    cells_.push_back(cell);
    std::push_heap(cells_.begin(), cells_.end(), SphericalTriangle::less_promising);
  }

  // The largest distance from y to a point of the cap around `middle`, whose rim is `chord` away from its middle on the
  // unit sphere.
  double farthest(const Point& y, const Vector& middle, double chord) const {
    const Vector to_y = y - sphere_.center;
    const double length = to_y.norm(), r = sphere_.radius;
    const double sine = std::min(1.0, chord / 2);
    const detail::HalfAngle cap{sine, std::sqrt((1 - sine) * (1 + sine))};
    const double half_chord = detail::HalfAngle::between(middle, 1, to_y, length).half_chord_with(cap);
    return std::sqrt((r - length) * (r - length) + 4 * r * length * half_chord * half_chord);
  }

  // A bound on the distance of any point q of the cap from the nearer of two points y and z. The square of that
  // distance is at most the mean (1 - t) |q - y|^2 + t |q - z|^2, which equals |q - m|^2 + t (1 - t) |y - z|^2 with the
  // mean m = (1 - t) y + t z. Where the surface is equally near on two sides of the sphere's farthest point, y or z
  // alone gives a bound whose error grows with the size of the cap; but if m lies on the line through the cap's middle
  // and the sphere's centre, the error grows with the square of the size only.
  double farthest_of_both(const Point& y, const Point& z, const Vector& middle, double chord) const {
    const Vector between = z - y, across = between - between.dot(middle) * middle;
    const double squared = across.squaredNorm();
    if (!(squared > 0)) return upper_everywhere_;
    const double part = std::clamp(across.dot(sphere_.center - y) / squared, 0.0, 1.0);
    const double away = farthest(y + part * between, middle, chord);
    return std::sqrt(away * away + part * (1 - part) * between.squaredNorm());
  }

  const Surface& surface_;
  const detail::InteriorSurface interior_;
  const Sphere sphere_;
  const double radius_;  // R
  const DistanceTolerance tolerance_;
  Point anchor_ = Point::Zero();
  double upper_everywhere_ = 0, best_ = 0, dropped_ = 0;
  int evaluations_ = 0;
  std::vector<SphericalTriangle> cells_;
};

}  // namespace

Bounds inaccuracy(const Surface& surface, const Sphere& sphere, const DistanceTolerance& tolerance) {
  return SphereSearch(surface, sphere, tolerance).run();
}

double distance_bound(double signed_distance_of_center, double radius) {
  const double sum = radius + signed_distance_of_center;
  if (sum <= 0) return 0;
  const double rounding = 0x1p-50 * (radius + std::abs(signed_distance_of_center));
  return std::nextafter(sum + rounding, std::numeric_limits<double>::infinity());
}

}  // namespace orchard
