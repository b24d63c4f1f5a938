#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

// Measures the local thickness of a solid. docs/guide/thickness.md explains the definitions with pictures.
namespace orchard {

// The definition of the thickness at a place of the surface.
enum class ThicknessDefinition : std::uint8_t {
  // The diameter of the largest ball in the solid that touches the surface at the place.
  ball,
  // The distance from the place to the next place of the surface along the inward normal.
  ray
};

// The options of thickness_at() and local_thickness().
struct ThicknessOptions {
  ThicknessDefinition definition = ThicknessDefinition::ball;
  // An angle in radians, in [0, pi]. A place has a thickness if it faces another place of the surface that its ball
  // touches: the angle between the two, seen from the centre of the ball, is at least this. For a ray, the normals at
  // its two ends must differ by at least this angle. Lower values also accept balls in wedges, which measure the
  // distance to an edge. The default is 120 degrees.
  double facing = 2.0943951023931953;
  // An angle in radians, in (0, pi / 2]; the default is 40 degrees. Where adjacent triangles turn by less than this,
  // they are taken for the facets of a smooth surface. This has two effects:
  // - A ball does not end at contacts that are seen from its centre at less than this angle from the place, because
  //   these are neighbouring facets.
  // - A ball may end too early at a facet that does not face the place. The place then still has a thickness: the
  //   diameter of the ball that ends at a contact facing the place, if the first ball is at most 25 % smaller. The
  //   percentage is proportional to the turn between facets: 25 % at this angle.
  // Where triangles turn by more, the mesh has an edge, at which balls shrink to points. With values near 0, the balls
  // are those of the polyhedron itself.
  double smooth = 0.6981317007977318;
  // The approximate number of triangles into which local_thickness() divides the surface. The result has values at the
  // corners and middles of these triangles. Larger meshes are not coarsened.
  Index samples = 20'000;
  // The maximum number of nodes of the search tree that are visited for one place. A search that reaches it returns the
  // value found so far, with its proven error. This happens if a ball almost touches thousands of triangles, as in a
  // finely meshed sphere.
  Index work = 3'000;
};

// A place of a surface: its position, its triangle, and whether it lies on a corner, an edge or the face of the
// triangle.
struct SurfacePlace {
  Point position = Point::Zero();
  Index triangle = 0;
  Feature feature = Feature::face;
};

// The ball or ray that measures the thickness at a place. `diameter` is 0 on convex edges. It is NaN where there is no
// normal (on degenerate triangles) and where there is no surface in front (on open surfaces).
struct ThicknessAt {
  double diameter = 0;  // In mesh units.
  // A proven bound: `diameter`, and `thickness` where a complete search would define it, are too large by at most this.
  // It is above 0 if options.work ended a search, and infinite if that leaves open whether there is a thickness.
  double error = 0;
  // The thickness, in mesh units; NaN if the place faces no contact. It is `diameter`, or a little more where facets
  // ended that ball too early (see ThicknessOptions::smooth).
  double thickness = 0;
  Point contact = Point::Zero();  // The other end: of `thickness` if it is defined, otherwise of `diameter`.
  double angle = 0;               // The angle between both ends in radians, as in ThicknessOptions::facing.
  // The outward normal: the centre of the ball is at the place - diameter / 2 x normal.
  Vector normal = Vector::Zero();
};

// Measures the thickness at places that the caller chooses.
// On a face, the ball touches along the normal of the smooth surface that the mesh stands for, interpolated between
// triangles that turn by less than options.smooth. At an edge or vertex, it touches along the pseudonormal; where the
// surface is concave, it may touch along the normal of an adjacent triangle if that ball is larger. All triangles in
// front of the place count, whichever way they face. So if the surface cuts itself, a ball may end at a part of the
// surface inside the solid.
// The result is exact up to rounding (about 1e-12 of the diameter). Throws InputError if an option is out of range. The
// work is parallel, with the same result on any number of threads. A place takes about O(log n) for n triangles.
std::vector<ThicknessAt> thickness_at(const Surface& surface, std::span<const SurfacePlace> places,
                                      const ThicknessOptions& options = {}, const Progress& progress = {});

// A value for each vertex or each triangle of LocalThickness::mesh.
struct ThicknessValues {
  std::vector<double> ball_diameter;  // ThicknessAt::diameter, also for rays.
  std::vector<double> thickness;      // ThicknessAt::thickness.
  std::vector<double> contact_angle;  // In radians.
  std::vector<double> error;          // ThicknessAt::error.
  std::vector<Point> contacts;        // ThicknessAt::contact.
};

// The thickness of a whole surface.
struct LocalThickness {
  // The mesh of the surface with its long edges divided. The vertices of the surface come first, in their order.
  TriangleMesh mesh;
  std::vector<Index> of_triangle;             // The triangle of the surface that each triangle is a part of.
  ThicknessValues at_vertices, at_triangles;  // The values of triangles are those at their middles.
};

// Measures the thickness of a solid all over its surface. Throws InputError unless surface.solid(), and if an option is
// out of range. O(n log n).
LocalThickness local_thickness(const Surface& surface, const ThicknessOptions& options = {},
                               const Progress& progress = {});

// A connected part of the surface that is thinner than a limit.
struct ThinRegion {
  double area = 0;                 // In squared mesh units.
  double min_thickness = 0;        // In mesh units.
  Point thinnest = Point::Zero();  // The place of the smallest thickness.
  Box box;                         // The bounding box of the region.
  Index triangles = 0;             // The number of triangles of LocalThickness::mesh in the region.
};

// The regions of a surface that are thinner than a limit, the largest first. A region consists of triangles whose
// thickness is defined and below the limit by more than rounding (1e-9 of it), joined where they share a corner. Areas
// are in squared mesh units.
struct ThinRegions {
  double area = 0;          // The area of all regions.
  double defined_area = 0;  // The area of all triangles whose thickness is defined.
  double total_area = 0;    // The area of the surface.
  std::vector<ThinRegion> regions;
  // The region of each triangle of the mesh, or kNone.
  std::vector<Index> of_triangle;
};
// Finds the regions that are thinner than `below` (mesh units).
ThinRegions thin_regions(const LocalThickness& thickness, double below);

// The area of a surface by thickness, in bins of equal width from 0 to the largest value.
struct ThicknessHistogram {
  double bin_width = 0;                          // In mesh units.
  std::vector<double> thickness, ball_diameter;  // The area in each bin, in squared mesh units.
};
// Returns the histogram of a measured surface with the given number of bins.
ThicknessHistogram thickness_histogram(const LocalThickness& thickness, Index bins);

}  // namespace orchard
