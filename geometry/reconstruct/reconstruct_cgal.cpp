#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "../repair/cgal_mesh.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/reconstruct.h"

namespace orchard {
namespace {

using PoissonKernel = detail::CgalKernel;
using PointWithNormal = std::pair<PoissonKernel::Point_3, PoissonKernel::Vector_3>;

constexpr std::size_t kFewestPoints = 16;
constexpr unsigned kNeighbors = 6;
constexpr double kMinAngle = 20;  // of the triangles, in degrees
// Over the mean distance of points: how far each point is moved at most. CGAL's refinement of a triangulation fails if
// the centres of all balls coincide, as for the points of an exact sphere.
constexpr double kUnlike = 5e-3;

// Prevents CGAL's own checks from printing, and gives it the same random numbers in each call.
class QuietCgal {
 public:
  QuietCgal() : before_(CGAL::set_error_handler(silent)) { CGAL::get_default_random() = CGAL::Random(0); }
  ~QuietCgal() { CGAL::set_error_handler(before_); }
  QuietCgal(const QuietCgal&) = delete;
  QuietCgal& operator=(const QuietCgal&) = delete;

 private:
  static void silent(const char*, const char*, const char*, int, const char*) {}
  CGAL::Failure_function before_;
};

void make_unlike(std::vector<PointWithNormal>& points, double spacing) {
  Random random(0, 0, 0);
  for (PointWithNormal& point : points) {
    const auto shift = [&] { return random.uniform(-kUnlike, kUnlike) * spacing; };
    const double x = shift(), y = shift(), z = shift();
    point.first = point.first + PoissonKernel::Vector_3(x, y, z);
  }
}

// Makes degenerate triangles of points, so that distances to points are those to a mesh.
Surface surface_of_points(const std::vector<Point>& points) {
  TriangleMesh mesh{points, {}};
  for (Index i = 0; i < points.size(); ++i) mesh.triangles.push_back({i, i, i});
  return Surface(std::move(mesh));
}

void measure(const std::vector<Point>& points, ReconstructedMesh& result, const Progress& progress) {
  const Surface surface(result.mesh);
  for (const Point& point : points) {
    const double distance = surface.distance(point);
    result.mean_from_points += distance / static_cast<double>(points.size());
    result.max_from_points = std::max(result.max_from_points, distance);
  }
  result.to_points = surface_distance(surface, surface_of_points(points), {.tolerance = 1e-3}, progress);
}

}  // namespace

ReconstructedMesh reconstruct_surface(const OrientedPoints& points, const ReconstructOptions& options,
                                      const Progress& progress) {
  if (points.points.size() < kFewestPoints)
    throw InputError(std::to_string(points.points.size()) + " points with normals are too few; a surface needs " +
                     std::to_string(kFewestPoints));
  if (!(options.distance > 0) || !(options.radius > 0))
    throw InputError("the distance and the radius of a surface reconstruction must be above 0");
  report_progress(progress, "reconstruction", 0);
  std::vector<PointWithNormal> input;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Point& p = points.points[i];
    const Vector& n = points.normals[i];
    input.emplace_back(PoissonKernel::Point_3(p.x(), p.y(), p.z()), PoissonKernel::Vector_3(n.x(), n.y(), n.z()));
  }
  const auto place = CGAL::First_of_pair_property_map<PointWithNormal>();
  ReconstructedMesh result;
  result.spacing =
      CGAL::compute_average_spacing<CGAL::Sequential_tag>(input, kNeighbors, CGAL::parameters::point_map(place));
  if (!(result.spacing > 0)) throw InputError("all points lie in one place; a surface needs points around a solid");
  make_unlike(input, result.spacing);
  const QuietCgal quiet;
  detail::CgalMesh mesh;
  bool made = false;
  try {
    made = CGAL::poisson_surface_reconstruction_delaunay(input.begin(), input.end(), place,
                                                         CGAL::Second_of_pair_property_map<PointWithNormal>(), mesh,
                                                         result.spacing, kMinAngle, options.radius, options.distance);
  } catch (const std::exception&) {
    made = false;  // one of CGAL's own checks has failed: no surface surrounds a place that is inside
  }
  if (!made || mesh.is_empty())
    throw InputError("no closed surface fits the points and their normals; check that all normals point outward");
  result.mesh = detail::from_cgal(mesh);
  measure(points.points, result, progress);
  return result;
}

}  // namespace orchard
