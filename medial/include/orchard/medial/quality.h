#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"

namespace orchard {

// How good a medial mesh is for a solid, whichever system made it. docs/reference/medial-measures.md defines each
// metric and says what is perfect. The reconstruction is the union of the balls, cones and slabs of its vertices, edges
// and triangles.

struct QualityOptions {
  Index surface_samples = 100'000;  // for coverage and protrusion
  Index cells = 200'000;            // of each kind (vertices, edges, triangles) that are looked at, evenly chosen
  Index search = 250'000;           // parts at most in which the largest dent and protrusion are searched
  Index contact_cells = 10'000;     // vertices whose second contact is searched
  double contact_angle = 0.5235987755982988;  // radians, 30 degrees: half the opening of the first contact's cone
  double economy_error = 0.01;                // of the diagonal
  Index economy_candidates = 20'000, economy_samples = 20'000;
  Index worst_places = 5;      // of each kind that are named
  double places_apart = 0.05;  // of the diagonal: nearer ones of a kind are one place
  std::uint64_t seed = 1;
};

struct Spread {
  double max = 0, mean = 0;
};

struct Economy {
  Index spheres = 0;     // that a greedy cover needs
  double uncovered = 0;  // fraction of the samples that no admissible ball reaches
};

// What a medial mesh falls into where it is joined by less than edges.
struct MedialPieces {
  Index sheets = 0;  // sets of triangles joined across edges
  Index wires = 0;   // sets of edges without triangles, joined at vertices; a ball without edges is one, too
  // Of both, those whose bounding box has a diagonal below their largest radius: flakes and spikes. One that is alone
  // does not count.
  Index small = 0;
};
// O(n log n).
MedialPieces medial_pieces(const MedialMesh& mesh);
// The length of the edges that have one triangle, in mesh units: the borders of sheets, walls included. O(n log n).
double border_length(const MedialMesh& mesh);

enum class WorstKind : std::uint8_t { protrusion, coverage, dent };

// Where a metric is worst. A dent is a place of the reconstruction's boundary deep in the solid, and given where it is
// what the Hausdorff distance is largest at.
struct WorstPlace {
  WorstKind kind = WorstKind::protrusion;
  double value = 0;                  // over D
  Point position = Point::Zero();    // of the reconstruction, farthest outside or inside; or of the surface, uncovered
  Vector outward = Vector::Zero();   // the surface's unit normal there
  Sphere ball = {Point::Zero(), 0};  // of the reconstruction: that which protrudes; or the nearest one
};

struct MedialQuality {
  double diagonal = 0;  // D of the mesh's bounding box, in mesh units
  Spread hausdorff;     // two-sided distance between the surface and the reconstruction's boundary, over D
  Spread coverage;      // distance from the surface to the reconstruction, over D; the maximum searched, 1e-5 D low
  double coverage_upper = 0;  // proven, up to rounding: no place of the surface is farther from the reconstruction
  // Of coverage, what is not at the borders of sheets, where what is pruned is missing. NaN if the mesh has neither
  // edges nor triangles: then every ball is a border.
  Spread inner_coverage;
  Spread protrusion;  // distance of the reconstruction outside the solid, over D
  // Proven, up to rounding: no ball reaches farther beyond the place of the surface that is nearest to its centre. More
  // than what protrudes where a ball closes a crevice.
  double protrusion_upper = 0;
  double dent_upper = 0;  // proven: no place of the reconstruction's boundary is deeper in the solid
  Spread radius_error;    // |radius - distance to the surface| of vertices, over D
  Spread centredness;     // |distance to the second contact - radius| of vertices, over the radius; NaN without any
  double outside_vertices = 0, outside_edges = 0, outside_triangles = 0;  // fractions; by more than 1e-9 D
  Topology found, wanted;                                                 // of the medial mesh; of the solid
  Economy economy;
  Index balls = 0;           // vertices of the medial mesh
  double border_length = 0;  // over D
  MedialPieces pieces;
  std::vector<WorstPlace> worst;  // protrusion first, then coverage, each from the worst down; of values above 1e-6
};

// Deterministic for a seed; parallel. Throws InputError unless surface.solid() and validate(mesh) passes.
MedialQuality medial_quality(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options = {},
                             const Progress& progress = {});

// What is wrong with single balls of an axis: lengths over the diagonal of the surface's bounding box.
struct BallErrors {
  std::vector<double> radius_error, protrusion;
  std::vector<double> centredness;  // over the radius; NaN where there is no second contact or next to no radius
};
// By the definitions of medial_quality(), of each ball; no centredness, which takes longest, if options.contact_cells
// is 0. Parallel. Throws InputError unless surface.solid().
BallErrors ball_errors(const Surface& surface, std::span<const Sphere> balls, const QualityOptions& options = {});

// The protrusion alone.
std::vector<double> ball_protrusions(const Surface& surface, std::span<const Sphere> balls);

// What is wrong with the reconstruction at single points of the surface, over the diagonal.
struct SurfaceErrors {
  std::vector<double> coverage, protrusion;
};
// By the definitions of medial_quality(), of each point; normals: outward, unit length. Parallel. Throws InputError
// unless surface.solid().
SurfaceErrors surface_errors(const Surface& surface, const MedialMesh& mesh, std::span<const Point> points,
                             std::span<const Vector> normals);

// The noise is a smooth random field: independent displacements on a lattice, interpolated in between. It does not know
// the mesh's triangles, which are divided where they are too long for it: a solid's figure is that of the solid,
// however fine its mesh is, and no noise crumples a mesh whose triangles are no larger than it.
struct StabilityOptions {
  double noise = 0.001;       // every place of the surface moves by at most this, in diagonals
  double correlation = 0.05;  // above 0: spacing of the lattice, in diagonals; farther apart, places move on their own
  double object_angle = 1.0472;  // radians, 60 degrees: half the angle between the contacts
  std::uint64_t seed = 1;
};

// Distances between two axes, from the vertices of each to the other, over the noise.
struct MedialStability {
  double hausdorff = 0, percentile99 = 0, mean = 0;
};

// Of the medial axis of the mesh and that of the mesh with noise, both built with `options`, the other one from the
// points of the first, which move with the mesh, those that were added to the sampling included; only what has a larger
// object angle is compared (with what has one at most 10 degrees smaller).
// Nothing if the noise makes the mesh no solid, or if an axis has no such part.
std::optional<MedialStability> medial_stability(const Surface& surface, const MedialBuild& build,
                                                const MedialBuildOptions& options,
                                                const StabilityOptions& stability = {}, const Progress& progress = {});

// The radius of the largest ball that touches each vertex of the surface's mesh, of those of `mesh`'s vertices: the
// local thickness, halved. A ball touches if it comes as near as the nearest, up to 0.001 bounding radii.
std::vector<double> medial_radii_at_surface(const Surface& surface, const MedialMesh& mesh);

}  // namespace orchard
