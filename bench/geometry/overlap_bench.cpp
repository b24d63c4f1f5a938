// Triangles that meet a triangle, queries per second, one thread: orchard's tree against CGAL's AABB tree with exact
// predicates. A query is a triangle of the mesh, moved a little or stretched across the mesh. The last column counts
// the queries on which the two disagree. Usage: orchard_overlap_bench mesh...
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "measure.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"

namespace orchard {
namespace {

using Corners = std::array<Point, 3>;

class CgalTree {
 public:
  explicit CgalTree(const Surface& surface) {
    for (Index t = 0; t < surface.mesh().triangles.size(); ++t)
      if (surface.area(t) > 0) triangles_.push_back(triangle(surface.corners(t)));
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
  }
  std::size_t count(const Corners& query) const {
    found_.clear();
    tree_.all_intersected_primitives(triangle(query), std::back_inserter(found_));
    return found_.size();
  }

 private:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
  using Traits = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Iterator>>;
  static Kernel::Triangle_3 triangle(const Corners& c) {
    const auto point = [](const Point& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
    return {point(c[0]), point(c[1]), point(c[2])};
  }
  std::vector<Kernel::Triangle_3> triangles_;
  CGAL::AABB_tree<Traits> tree_;
  mutable std::vector<Iterator> found_;
};

std::vector<Corners> queries(const Surface& surface, bool stretched) {
  std::vector<Corners> result;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Random random(1, i);
    Corners corners = surface.corners(static_cast<Index>(random.below(surface.mesh().triangles.size())));
    const auto in_cube = [&] { return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    const Vector shift = 1e-2 * surface.bounding_radius() * in_cube();
    for (Point& p : corners) p += shift;
    if (stretched) corners[0] += 0.5 * surface.bounding_radius() * in_cube();
    if ((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() > 0) result.push_back(corners);
  }
  return result;
}

void run(const std::string& file) {
  const Surface surface(read_mesh(file));
  const CgalTree cgal(surface);
  std::printf("%s: %zu triangles\n", file.c_str(), surface.mesh().triangles.size());
  std::vector<Index> found;
  for (const bool stretched : {false, true}) {
    const std::vector<Corners> triangles = queries(surface, stretched);
    const auto ours = measure<std::size_t>(triangles, [&](const Corners& query) {
      surface.triangles_overlapping(query, found);
      return static_cast<std::size_t>(
          std::count_if(found.begin(), found.end(), [&](Index t) { return surface.area(t) > 0; }));
    });
    const auto theirs = measure<std::size_t>(triangles, [&](const Corners& query) { return cgal.count(query); });
    std::size_t hits = 0, differing = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      hits += ours.answers[i];
      differing += ours.answers[i] != theirs.answers[i];
    }
    std::printf("  %-10s %6.1f met; orchard %7.1f k/s, CGAL %7.1f k/s: %5.2f times as fast; %zu differ\n",
                stretched ? "stretched" : "moved", static_cast<double>(hits) / static_cast<double>(triangles.size()),
                ours.thousand_per_second, theirs.thousand_per_second,
                ours.thousand_per_second / theirs.thousand_per_second, differing);
  }
}

}  // namespace
}  // namespace orchard

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) orchard::run(argv[i]);
}
