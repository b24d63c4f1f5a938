#include "orchard/voronoi/exact.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "algorithms/build.h"
#include "predicates/predicates.h"

namespace orchard {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>;
using CellBase =
    CGAL::Triangulation_cell_base_with_info_3<Index, Kernel, CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

// A circumcentre that magnifies rounding errors more than this many times is computed with rational numbers.
constexpr double kWellConditioned = 0x1p10;

constexpr std::size_t kPlacedAtOnce = 1024;  // vertices of one task of a thread

// Returns all points in the order of their positions, and identical ones in the order of their indices.
std::vector<Index> by_position(std::span<const Point> points) {
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto key = [&](Index i) { return std::tie(points[i].x(), points[i].y(), points[i].z()); };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  return order;
}

// Returns pairs of a point that is left out and the lowest point that it is identical to.
std::vector<std::array<Index, 2>> identical(std::span<const Point> points) {
  std::vector<std::array<Index, 2>> pairs;
  Index first = kNone;
  for (const Index i : by_position(points)) {
    if (first != kNone && points[i] == points[first])
      pairs.push_back({i, first});
    else
      first = i;
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Returns the points that are not left out, each with its index.
std::vector<std::pair<Kernel::Point_3, Index>> distinct_points(std::span<const Point> points) {
  std::vector<Index> order = by_position(points);
  order.erase(std::unique(order.begin(), order.end(), [&](Index a, Index b) { return points[a] == points[b]; }),
              order.end());
  std::sort(order.begin(), order.end());
  std::vector<std::pair<Kernel::Point_3, Index>> distinct;
  distinct.reserve(order.size());
  for (Index i : order) distinct.emplace_back(Kernel::Point_3(points[i].x(), points[i].y(), points[i].z()), i);
  return distinct;
}

Point rational_circumcenter(const std::array<Point, 4>& p) {
  using Rational = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const auto exact = [](const Point& q) { return Rational::Point_3(q.x(), q.y(), q.z()); };
  const auto center = CGAL::circumcenter(exact(p[0]), exact(p[1]), exact(p[2]), exact(p[3]));
  return {CGAL::to_double(center.x()), CGAL::to_double(center.y()), CGAL::to_double(center.z())};
}

// Returns a power of two of about the size of the largest component. After division by it, products of several
// components neither overflow nor underflow, and no digit changes.
double binary_size(const Vector& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0 && std::isfinite(largest) ? std::ldexp(1.0, std::ilogb(largest)) : 1;
}

double length(const Vector& v) {
  const double unit = binary_size(v);
  return (v / unit).norm() * unit;
}

void place_finite(VoronoiVertex& vertex, std::span<const Point> points) {
  std::array<Point, 4> p;
  for (unsigned i = 0; i < 4; ++i) p[i] = points[vertex.forming_points[i]];
  double unit = 0;
  for (unsigned i = 0; i < 3; ++i) unit = std::max(unit, binary_size(p[i] - p[3]));
  const auto from = [&](unsigned i) { return detail::LengthedVector((p[i] - p[3]) / unit); };
  const auto relative = detail::circumcenter(from(0), from(1), from(2));
  const bool good = relative.condition < kWellConditioned;
  vertex.center = good ? Point(p[3] + relative.center * unit) : rational_circumcenter(p);
  vertex.radius = length(vertex.center - p[3]);
}

// Returns the normal of the triangle a, b, c, computed with rational numbers. Its length is not 1.
Vector rational_normal(const Point& a, const Point& b, const Point& c) {
  using Rational = CGAL::Simple_cartesian<CGAL::Exact_rational>;
  const auto exact = [](const Point& q) { return Rational::Point_3(q.x(), q.y(), q.z()); };
  const auto normal = CGAL::cross_product(exact(b) - exact(a), exact(c) - exact(a));
  const auto largest = std::max({CGAL::abs(normal.x()), CGAL::abs(normal.y()), CGAL::abs(normal.z())});
  if (largest == 0) return Vector::Zero();
  const auto part = [&](const CGAL::Exact_rational& x) { return CGAL::to_double(CGAL::Exact_rational(x / largest)); };
  return {part(normal.x()), part(normal.y()), part(normal.z())};
}

void place_at_infinity(VoronoiVertex& vertex, std::span<const Point> points) {
  std::array<Index, 4> corner = vertex.forming_points;
  // An odd permutation moves the infinite point from i to the last place, and another swap makes the permutation even.
  const auto i = static_cast<std::size_t>(std::find(corner.begin(), corner.end(), kInfinitePoint) - corner.begin());
  if (i != 3) {
    std::swap(corner[i], corner[3]);
    std::swap(corner[0], corner[1]);
  }
  const Point &a = points[corner[0]], &b = points[corner[1]], &c = points[corner[2]];
  const Vector u = (b - a) / binary_size(b - a), v = (c - a) / binary_size(c - a), normal = u.cross(v);
  const bool good = u.norm() * v.norm() < kWellConditioned * normal.norm();
  vertex.center = (good ? normal : rational_normal(a, b, c)).normalized();
  vertex.radius = std::numeric_limits<double>::infinity();
}

}  // namespace

VoronoiBuild exact_voronoi(std::span<const Point> points) {
  detail::checked_box(points);
  const auto distinct = distinct_points(points);
  Delaunay delaunay(distinct.begin(), distinct.end());
  VoronoiBuild build{{}, {.dimension = std::max(delaunay.dimension(), 0), .duplicates = identical(points)}};
  VoronoiDiagram& diagram = build.diagram;
  diagram.points.assign(points.begin(), points.end());
  if (delaunay.dimension() < 3) return build;

  Index count = 0;
  for (auto cell : delaunay.all_cell_handles()) cell->info() = count++;
  diagram.vertices.resize(count);
  for (auto cell : delaunay.all_cell_handles()) {
    VoronoiVertex& vertex = diagram.vertices[cell->info()];
    for (int i = 0; i < 4; ++i) {
      const auto corner = cell->vertex(i);
      const auto slot = static_cast<unsigned>(i);
      vertex.forming_points[slot] = delaunay.is_infinite(corner) ? kInfinitePoint : corner->info();
      vertex.neighbors[slot] = cell->neighbor(i)->info();
    }
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kPlacedAtOnce), [&](const auto& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      VoronoiVertex& vertex = diagram.vertices[v];
      vertex.at_infinity() ? place_at_infinity(vertex, points) : place_finite(vertex, points);
    }
  });
  return build;
}

}  // namespace orchard
