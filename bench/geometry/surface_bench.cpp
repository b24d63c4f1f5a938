// Closest-point queries per second, one thread: orchard's four-wide tree against Embree 3 (point queries on a user
// geometry, with the same exact triangle distance in the callback) and CGAL's AABB tree. The last column says how far
// the answers are from orchard's, over the bounding radius: a base that is not exact cannot be chosen however fast it
// is. Usage: orchard_surface_bench mesh...
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string>

#include "measure.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

using Closest = std::function<double(const Point&)>;  // the distance

class CgalTree {
 public:
  explicit CgalTree(const TriangleMesh& mesh) {
    const auto point = [&](Index v) {
      const Point& p = mesh.vertices[v];
      return Kernel::Point_3(p.x(), p.y(), p.z());
    };
    for (const auto& [a, b, c] : mesh.triangles) triangles_.emplace_back(point(a), point(b), point(c));
    std::erase_if(triangles_, [](const auto& t) { return t.is_degenerate(); });
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
    tree_.accelerate_distance_queries();
  }
  double distance(const Point& q) const {
    return std::sqrt(tree_.squared_distance(Kernel::Point_3(q.x(), q.y(), q.z())));
  }

 private:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Kernel::Triangle_3>::const_iterator>;
  std::vector<Kernel::Triangle_3> triangles_;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree_;
};

// Floats around the centre of the mesh; boxes are rounded outward, and the radius of a query by the error of its
// position.
class EmbreeTree {
 public:
  explicit EmbreeTree(const Surface& surface)
      : surface_(surface),
        center_(surface.bounding_box().center()),
        device_(rtcNewDevice(nullptr)),
        scene_(rtcNewScene(device_)) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(surface.mesh().triangles.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
    rtcSetGeometryPointQueryFunction(geometry, visit);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    rtcCommitScene(scene_);
  }
  EmbreeTree(const EmbreeTree&) = delete;
  ~EmbreeTree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  double distance(const Point& q) const {
    const Point local = q - center_;
    Query query{surface_, q, std::numeric_limits<double>::infinity(),
                2e-7 * (local.norm() + surface_.bounding_radius())};
    RTCPointQuery point{};
    point.x = static_cast<float>(local.x()), point.y = static_cast<float>(local.y()),
    point.z = static_cast<float>(local.z());
    point.radius = std::numeric_limits<float>::infinity();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &point, &context, nullptr, &query);
    return query.best;
  }

 private:
  struct Query {
    const Surface& surface;
    Point position;
    double best, slack;
  };
  static void bound(const RTCBoundsFunctionArguments* args) {
    const auto& self = *static_cast<const EmbreeTree*>(args->geometryUserPtr);
    Box box;
    for (const Point& p : self.surface_.corners(args->primID)) box.extend(Point(p - self.center_));
    const auto down = [](double x) { return std::nextafter(static_cast<float>(x), -HUGE_VALF); };
    const auto up = [](double x) { return std::nextafter(static_cast<float>(x), HUGE_VALF); };
    RTCBounds& b = *args->bounds_o;
    b.lower_x = down(box.min().x()), b.lower_y = down(box.min().y()), b.lower_z = down(box.min().z());
    b.upper_x = up(box.max().x()), b.upper_y = up(box.max().y()), b.upper_z = up(box.max().z());
  }
  static bool visit(RTCPointQueryFunctionArguments* args) {
    auto& query = *static_cast<Query*>(args->userPtr);
    const auto [a, b, c] = query.surface.corners(args->primID);
    const double distance = closest_point_of_triangle(query.position, a, b, c).distance;
    if (distance >= query.best) return false;
    query.best = distance;
    args->query->radius = std::nextafter(static_cast<float>(distance + query.slack), HUGE_VALF);
    return true;
  }
  const Surface& surface_;
  Point center_;
  RTCDevice device_;
  RTCScene scene_;
};

struct Place {
  const char* name;
  std::vector<Point> queries;
};

std::vector<Place> places(const Surface& surface, int count) {
  const Box& box = surface.bounding_box();
  Place in_box{"uniform in the box", {}}, near{"within 0.1 % R of the surface", {}},
      around{"in a box five times as large", {}};
  for (int i = 0; i < count; ++i) {
    Random random(1, 0, static_cast<std::uint64_t>(i));
    const auto in_cube = [&] { return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    const Vector offset = 0.5 * in_cube().cwiseProduct(box.sizes());
    in_box.queries.push_back(box.center() + offset);
    around.queries.push_back(box.center() + 5 * offset);
    const auto [a, b, c] = surface.corners(static_cast<Index>(random.below(surface.mesh().triangles.size())));
    const double u = random.uniform(), v = random.uniform(0, 1 - u);
    near.queries.push_back(a + u * (b - a) + v * (c - a) + 1e-3 * surface.bounding_radius() * in_cube());
  }
  return {in_box, near, around};
}

void run(const std::string& file) {
  const Surface surface(read_mesh(file));
  const CgalTree cgal(surface.mesh());
  const EmbreeTree embree(surface);
  std::printf("%s: %zu triangles\n", file.c_str(), surface.mesh().triangles.size());
  for (const auto& [name, queries] : places(surface, 200000)) {
    const auto ours = measure<double>(queries, [&](const Point& q) { return surface.distance(q); });
    std::printf("  %s\n    orchard %8.0f k/s\n", name, ours.thousand_per_second);
    const auto compare = [&](const char* peer, const Measured<double>& theirs) {
      double worst = 0;
      for (std::size_t i = 0; i < queries.size(); ++i)
        worst = std::max(worst, std::abs(theirs.answers[i] - ours.answers[i]));
      std::printf("    %-7s %8.0f k/s, orchard is %5.2f times as fast; answers differ by %.1e R\n", peer,
                  theirs.thousand_per_second, ours.thousand_per_second / theirs.thousand_per_second,
                  worst / surface.bounding_radius());
    };
    compare("Embree", measure<double>(queries, [&](const Point& q) { return embree.distance(q); }));
    compare("CGAL", measure<double>(queries, [&](const Point& q) { return cgal.distance(q); }));
  }
}

}  // namespace
}  // namespace orchard

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) orchard::run(argv[i]);
}
