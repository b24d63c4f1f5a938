#include "voronoi/diagram/diagram_judge.h"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cmath>

namespace orchard::test {
namespace {

using Rational = CGAL::Exact_rational;
// 113 bits, for what is beyond doubles but not worth a rational number.
#ifdef __SIZEOF_FLOAT128__
__extension__ using Quad = __float128;
#else
using Quad = long double;
#endif

constexpr double kCoincident = 1.001e-7;  // over the bounding radius: what may be left out, and a little

constexpr double kEpsilon = 0x1p-53, kQuadEpsilon = 0x1p-112;
constexpr double kGood =
    1e-11;  // what a centre or a normal may be off for the next kind of number not to be called for

template <class Number>
struct Coordinates {
  Number x, y, z;

  Coordinates(Number a, Number b, Number c) : x(a), y(b), z(c) {}
  Coordinates(const Point& a, const Point& b)
      : x(Number(a.x()) - Number(b.x())), y(Number(a.y()) - Number(b.y())), z(Number(a.z()) - Number(b.z())) {}

  Coordinates cross(const Coordinates& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
  Number dot(const Coordinates& o) const { return x * o.x + y * o.y + z * o.z; }
};

double rounded(Quad a) { return static_cast<double>(a); }
double rounded(double a) { return a; }
double rounded(const Rational& a) { return CGAL::to_double(a); }

// The centre of the sphere through four points, relative to the first, and how much rounding is magnified in it. False
// if they lie in a plane.
template <class Number>
bool sphere_center(const std::array<Point, 4>& p, Vector& center, double& condition) {
  const Coordinates<Number> a(p[1], p[0]), b(p[2], p[0]), c(p[3], p[0]);
  const Coordinates<Number> bc = b.cross(c), ca = c.cross(a), ab = a.cross(b);
  const Number twice = 2 * a.dot(bc), aa = a.dot(a), bb = b.dot(b), cc = c.dot(c);
  if (twice == 0) return false;
  center = Vector(rounded(Number((aa * bc.x + bb * ca.x + cc * ab.x) / twice)),
                  rounded(Number((aa * bc.y + bb * ca.y + cc * ab.y) / twice)),
                  rounded(Number((aa * bc.z + bb * ca.z + cc * ab.z) / twice)));
  condition = std::sqrt(rounded(aa) * rounded(bb) * rounded(cc)) / std::abs(rounded(twice));
  return true;
}

bool sphere_center(const std::array<Point, 4>& p, Vector& center) {
  double condition = 0;
  // Errors of the determinants are some dozens of roundings of the absolute products.
  if (sphere_center<double>(p, center, condition) && 100 * kEpsilon * condition < kGood) return true;
  if (sphere_center<Quad>(p, center, condition) && 100 * kQuadEpsilon * condition < kGood) return true;
  return sphere_center<Rational>(p, center, condition);
}

// The unit normal of a hull's facet, away from the hull. False if the points are on a line.
template <class Number>
bool facet_normal(const std::array<Point, 3>& p, Vector& normal, double& condition) {
  const Coordinates<Number> a(p[1], p[0]), b(p[2], p[0]), n = a.cross(b);
  const auto magnitude = [](const Number& x) { return x < 0 ? Number(-x) : x; };
  const Number max = std::max({magnitude(n.x), magnitude(n.y), magnitude(n.z)});
  if (max == 0) return false;
  normal = Vector(rounded(Number(n.x / max)), rounded(Number(n.y / max)), rounded(Number(n.z / max)));
  normal.normalize();
  condition = std::sqrt(rounded(a.dot(a)) * rounded(b.dot(b))) / rounded(max);
  return true;
}

bool facet_normal(const std::array<Point, 3>& p, Vector& normal) {
  double condition = 0;
  if (facet_normal<double>(p, normal, condition) && 100 * kEpsilon * condition < kGood) return true;
  if (facet_normal<Quad>(p, normal, condition) && 100 * kQuadEpsilon * condition < kGood) return true;
  return facet_normal<Rational>(p, normal, condition);
}

// The corners of a facet, with the infinite point moved to the end by an even permutation.
std::array<Index, 3> facet_corners(const VoronoiVertex& vertex) {
  std::array<Index, 4> corner = vertex.forming_points;
  const auto i = static_cast<std::size_t>(std::find(corner.begin(), corner.end(), kInfinitePoint) - corner.begin());
  if (i != 3) {
    std::swap(corner[i], corner[3]);
    std::swap(corner[0], corner[1]);
  }
  return {corner[0], corner[1], corner[2]};
}

struct Present {
  Eigen::ArrayXd x, y, z;
  double radius;

  explicit Present(const std::vector<Point>& points) {
    const auto count = static_cast<Eigen::Index>(points.size());
    x.resize(count), y.resize(count), z.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Point& p = points[static_cast<std::size_t>(i)];
      x[i] = p.x(), y[i] = p.y(), z[i] = p.z();
    }
    radius = std::hypot(x.maxCoeff() - x.minCoeff(), y.maxCoeff() - y.minCoeff(), z.maxCoeff() - z.minCoeff()) / 2;
  }
};

// How deep the deepest point is in the sphere around origin + center that goes through the origin.
double depth_in_sphere(const Present& present, const Point& origin, const Vector& center) {
  const double r = center.norm();
  const auto x = present.x - origin.x(), y = present.y - origin.y(), z = present.z - origin.z();
  const double power =
      std::max(0.0, (x * (2 * center.x() - x) + y * (2 * center.y() - y) + z * (2 * center.z() - z)).maxCoeff());
  return power / (r + std::sqrt(std::max(0.0, r * r - power)));
}

double height_beyond(const Present& present, const Point& origin, const Vector& normal) {
  return std::max(0.0, ((present.x - origin.x()) * normal.x() + (present.y - origin.y()) * normal.y() +
                        (present.z - origin.z()) * normal.z())
                           .maxCoeff());
}

}  // namespace

Judgement judge(const VoronoiDiagram& diagram) {
  std::vector<bool> forming(diagram.points.size(), false);
  for (const VoronoiVertex& vertex : diagram.vertices)
    for (const Index p : vertex.forming_points)
      if (p != kInfinitePoint) forming[p] = true;
  std::vector<Point> judged;
  for (Index p = 0; p < diagram.points.size(); ++p)
    if (forming[p]) judged.push_back(diagram.points[p]);

  Judgement result;
  const Present present(judged);
  const double near = kCoincident * present.radius;
  for (Index p = 0; p < diagram.points.size(); ++p)
    result.missing += !forming[p] && std::none_of(judged.begin(), judged.end(), [&](const Point& q) {
      return (q - diagram.points[p]).norm() <= near;
    });
  for (Index v = 0; v < diagram.vertices.size(); ++v) {
    const VoronoiVertex& vertex = diagram.vertices[v];
    if (vertex.at_infinity()) {
      const auto corner = facet_corners(vertex);
      const std::array<Point, 3> p{diagram.points[corner[0]], diagram.points[corner[1]], diagram.points[corner[2]]};
      Vector normal;
      if (!facet_normal(p, normal)) {
        ++result.flat;
        continue;
      }
      const double beyond = height_beyond(present, p[0], normal) / present.radius;
      if (beyond > result.beyond) result.beyond = beyond, result.facet = v;
      continue;
    }
    std::array<Point, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = diagram.points[vertex.forming_points[k]];
    Vector center;
    if (!sphere_center(p, center)) {
      ++result.flat;
      continue;
    }
    const double intrusion = depth_in_sphere(present, p[0], center) / present.radius;
    if (intrusion > result.deepest) result.deepest = intrusion, result.sphere = v;
  }
  return result;
}

}  // namespace orchard::test
