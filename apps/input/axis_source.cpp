#include "input/axis_source.h"

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/medial/read_axis.h"
#include "orchard/voronoi/diagram_io.h"

namespace orchard::apps {
namespace {

struct PlacedPoints {
  SurfaceSampling sampling;
  double max_moved = 0;
};

// Moves points onto the surface.
PlacedPoints on_surface(std::vector<Point> points, const Surface& surface) {
  PlacedPoints own;
  own.sampling.points = std::move(points);
  own.sampling.origins.assign(own.sampling.points.size(), PointOrigin::face);
  for (Point& point : own.sampling.points) {
    const ClosestPoint place = surface.closest(point);
    own.max_moved = std::max(own.max_moved, place.distance);
    own.sampling.triangles.push_back(place.triangle);
    own.sampling.features.push_back(place.feature);
    point = place.position;
  }
  return own;
}

OwnDiagram read_diagram(const std::filesystem::path& file, const Surface& surface) {
  OwnDiagram own{.diagram = read_vor(file), .sampling = {}};
  PlacedPoints placed = on_surface(own.diagram.points, surface);
  if (placed.max_moved > tolerance::kOnTriangle * surface.bounding_radius())
    throw InputError(file.string() + ": a point lies " + std::to_string(placed.max_moved) +
                     " off the mesh; give the diagram of points that lie on the mesh");
  own.sampling = std::move(placed.sampling);
  own.sampling.points = own.diagram.points;
  return own;
}

}  // namespace

std::vector<std::filesystem::path> AxisSource::files() const {
  std::vector<std::filesystem::path> given;
  for (const std::filesystem::path& file : {points, diagram, axis})
    if (!file.empty()) given.push_back(file);
  return given;
}

OwnInput read_axis_source(const AxisSource& source, const Surface& surface) {
  OwnInput own;
  if (!source.points.empty()) {
    MeshReading read = read_points_or_mesh_and_report(source.points);
    own.reading = std::move(read.report);
    PlacedPoints placed = on_surface(std::move(read.mesh.vertices), surface);
    if (placed.sampling.size() < 4) throw InputError(source.points.string() + ": at least four points are needed");
    own.max_moved = placed.max_moved;
    own.input.sampling = std::move(placed.sampling);
  }
  if (!source.diagram.empty()) own.input.diagram = read_diagram(source.diagram, surface);
  if (!source.axis.empty()) own.input.mesh = place_axis(surface, read_axis(source.axis)).mesh;
  return own;
}

}  // namespace orchard::apps
