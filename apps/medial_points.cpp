#include "medial_run.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/diagram_io.h"

namespace orchard::apps {
namespace {

// Where points lie on the surface; moves them there.
OwnPoints on_surface(std::vector<Point> points, const Surface& surface) {
  OwnPoints own;
  own.sampling.points = std::move(points);
  own.sampling.origins.assign(own.sampling.points.size(), PointOrigin::face);
  for (Point& point : own.sampling.points) {
    const ClosestPoint place = surface.closest(point);
    own.farthest_moved = std::max(own.farthest_moved, place.distance);
    own.sampling.triangles.push_back(place.triangle);
    own.sampling.features.push_back(place.feature);
    point = place.position;
  }
  return own;
}

}  // namespace

OwnPoints read_own_points(const std::filesystem::path& file, const Surface& surface) {
  OwnPoints own = on_surface(read_points_or_mesh(file).vertices, surface);
  if (own.sampling.size() < 4) throw InputError(file.string() + ": four points at least are needed");
  return own;
}

OwnDiagram read_own_diagram(const std::filesystem::path& file, const Surface& surface) {
  OwnDiagram own{.diagram = read_vor(file), .sampling = {}};
  OwnPoints placed = on_surface(own.diagram.points, surface);
  if (placed.farthest_moved > tolerance::kOnTriangle * surface.bounding_radius())
    throw InputError(file.string() + ": a point lies " + std::to_string(placed.farthest_moved) +
                     " off the mesh; the medial axis needs the diagram of points on it");
  own.sampling = std::move(placed.sampling);
  own.sampling.points = own.diagram.points;
  return own;
}

}  // namespace orchard::apps
