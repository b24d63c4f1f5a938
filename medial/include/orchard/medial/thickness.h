#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

// The local thickness of a solid. docs/guide/thickness.md explains the definitions with pictures.
namespace orchard {

enum class ThicknessDefinition : std::uint8_t {
  ball,  // the diameter of the largest ball in the solid that touches the surface at the place
  ray    // the way from the place along the inward normal to the surface
};

struct ThicknessOptions {
  ThicknessDefinition definition = ThicknessDefinition::ball;
  // Radians in [0, pi]. A place has a thickness where its ball touches the surface at a place that is seen from the
  // ball's centre at least this far from the first one, so that the two face each other; of a ray, where the surface's
  // normals at its ends are at least this far apart. Less lets balls in wedges count, which measure how near an edge
  // is: 120 degrees by default.
  double facing = 2.0943951023931953;
  // Radians in (0, pi / 2]. A mesh that turns by less than this around a place stands for a smooth surface: contacts
  // that a ball sees at less than this from the place do not end it, and a ball may be up to a quarter smaller than the
  // one that ends at a contact that faces the place, in proportion to how much the facets there turn. Edges that turn
  // by more are edges, where balls vanish: 40 degrees by default. With next to nothing, balls are those of the mesh's
  // own polyhedron.
  double smooth = 0.6981317007977318;
  // Edges are divided until the surface has about as many triangles, the values at whose middles and corners are the
  // result. Larger meshes are not made coarser.
  Index samples = 20'000;
  // Parts of the search tree that are looked at for one place, at most, before what was found is taken with what is
  // proven about it. It ends where thousands of triangles are as near to a ball as they can be, as in a fine sphere.
  Index work = 3'000;
};

// A place of a surface: where, on which triangle, and on which part of it.
struct SurfacePlace {
  Point position = Point::Zero();
  Index triangle = 0;
  Feature feature = Feature::face;
};

// The ball (or ray) that is as thick as the solid at a place. `diameter` is 0 on edges that stick out, and NaN where
// there is no normal (of degenerate triangles) and where nothing is in front of the surface (of an open one).
struct ThicknessAt {
  double diameter = 0;  // mesh units
  double error = 0;     // proven: the diameter is too large by no more than this; above 0 where work ended the search
  // Mesh units: the diameter of the ball that ends at a contact that faces the place; NaN if it has none. It is larger
  // than `diameter` by no more than facets cause (see ThicknessOptions::smooth).
  double thickness = 0;
  Point contact = Point::Zero();   // the other end: of `thickness`, or else of `diameter`
  double angle = 0;                // radians between both ends, as of ThicknessOptions::facing
  Vector normal = Vector::Zero();  // outward: the ball's centre is at the place - diameter / 2 x normal
};

// Of places of one's own. On faces the ball touches along the normal of the smooth surface that the mesh stands for,
// interpolated between triangles that turn by less than options.smooth; at an edge or vertex along the pseudonormal,
// or, where the surface is concave, along the normal of one of the triangles around if that ball is larger. Exact up to
// rounding (about 1e-12 of the diameter) for all triangles in front of the place, whichever way they face: where the
// surface cuts itself, a ball ends at a part that is inside the solid. About log n for each place; parallel; the same
// for any number of threads. Throws InputError for options out of range.
std::vector<ThicknessAt> thickness_at(const Surface& surface, std::span<const SurfacePlace> places,
                                      const ThicknessOptions& options = {}, const Progress& progress = {});

// A value for each vertex or each triangle of LocalThickness::mesh.
struct ThicknessValues {
  std::vector<double> ball_diameter;  // ThicknessAt::diameter, also for rays
  std::vector<double> thickness;      // ThicknessAt::thickness
  std::vector<double> contact_angle;  // radians
  std::vector<double> error;          // ThicknessAt::error
  std::vector<Point> contacts;        // the other ends
};

struct LocalThickness {
  TriangleMesh mesh;               // the surface's own, long edges divided; its vertices first, in their order
  std::vector<Index> of_triangle;  // the surface's triangle that each triangle is a part of
  ThicknessValues at_vertices, at_triangles;  // of triangles: at their middles
};

// O(n log n). Throws InputError unless surface.solid(), and for options out of range.
LocalThickness local_thickness(const Surface& surface, const ThicknessOptions& options = {},
                               const Progress& progress = {});

// A connected part of the surface that is thinner than a limit.
struct ThinRegion {
  double area = 0;                 // mesh units squared
  double min_thickness = 0;        // mesh units
  Point thinnest = Point::Zero();  // where
  Box box;                         // around all of it
  Index triangles = 0;             // of LocalThickness::mesh
};

// The regions of triangles whose thickness is defined and below the limit, by more than rounding (1e-9 of it), joined
// where they share a corner, the largest first.
struct ThinRegions {
  double area = 0;          // of all regions
  double defined_area = 0;  // of all triangles whose thickness is defined
  double total_area = 0;    // of the surface
  std::vector<ThinRegion> regions;
  std::vector<Index> of_triangle;  // the region of each triangle of the mesh; kNone: it is in none
};
ThinRegions thin_regions(const LocalThickness& thickness, double below);

// The surface's area by thickness, in bins of equal width from 0 to the largest value.
struct ThicknessHistogram {
  double bin_width = 0;                          // mesh units
  std::vector<double> thickness, ball_diameter;  // area in each bin
};
ThicknessHistogram thickness_histogram(const LocalThickness& thickness, Index bins);

}  // namespace orchard
