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

// Measures how well a medial mesh of any system stands for a solid. docs/reference/medial-measures.md defines each
// measure and its perfect value. The reconstruction is the union of the balls, cones and slabs of the mesh's vertices,
// edges and triangles. D is the diagonal of the bounding box of the surface.
namespace orchard {

// The options of medial_quality(). More samples and larger searches give tighter values and take longer.
struct QualityOptions {
  Index surface_samples = 100'000;  // The number of samples of the surface, for coverage and protrusion.
  Index cells = 200'000;  // The maximum number of vertices, edges and triangles that are measured, evenly chosen.
  // The maximum number of parts that each of the branch-and-bound searches for the largest dent and for the largest
  // protrusion examines.
  Index search = 250'000;
  Index contact_cells = 10'000;  // The maximum number of vertices for which the second contact is searched.
  // The second contact of a ball is the nearest surface point that is seen from its centre at this angle or more from
  // the nearest one; in radians, 30 degrees by default.
  double min_contact_angle = 0.5235987755982988;
  double economy_error = 0.01;  // The error that the greedy cover of `economy` may have, over D.
  // The maximum number of balls that the greedy cover chooses from, and the number of samples that it covers.
  Index economy_candidates = 20'000, economy_samples = 20'000;
  Index worst_places = 5;      // The number of worst places reported of each kind.
  double places_apart = 0.05;  // Places of a kind that are nearer than this, over D, count as one.
  std::uint64_t seed = 1;
};

// The largest and the mean value of a measure.
struct Spread {
  double max = 0, mean = 0;
};

// How many balls of the mesh a greedy cover of the surface needs. A ball is admissible if it protrudes by at most
// QualityOptions::economy_error.
struct Economy {
  Index spheres = 0;     // The number of balls of the cover.
  double uncovered = 0;  // The fraction of the samples that no admissible ball reaches.
};

// The pieces of a medial mesh: parts that are joined to each other at vertices only, or not at all.
struct MedialPieces {
  Index face_components = 0;  // Sets of triangles that are joined across edges, seams included.
  // Sets of edges without triangles that are joined at vertices. A ball without edges is such a set, too.
  Index curve_components = 0;
  // The pieces of both kinds with a bounding box whose diagonal is below the largest radius in the piece: flakes and
  // spikes. A mesh that is a single piece has none.
  Index small = 0;
};
// Counts the pieces of a medial mesh. O(n log n).
MedialPieces medial_pieces(const MedialMesh& mesh);
// Returns the total length, in mesh units, of the edges with exactly one triangle. These are the borders of sheets,
// topology faces included. O(n log n).
double border_length(const MedialMesh& mesh);

// The measure that a worst place belongs to.
enum class WorstKind : std::uint8_t { protrusion, coverage, dent };

// A place where a measure is worst. A dent is a place of the reconstruction's boundary deep inside the solid; the
// deepest one is reported if it determines the Hausdorff distance.
struct WorstPlace {
  WorstKind kind = WorstKind::protrusion;
  double value = 0;  // The value of the measure, over D.
  // The place of the reconstruction that is farthest outside or deepest inside, or the uncovered place of the surface.
  Point position = Point::Zero();
  Vector outward = Vector::Zero();   // The unit normal of the surface at this place.
  Sphere ball = {Point::Zero(), 0};  // The ball of the reconstruction that protrudes, or the nearest one.
};

// The measures of medial_quality().
struct MedialQuality {
  double diagonal = 0;  // D, in mesh units.
  Spread hausdorff;     // Two-sided distance between the surface and the reconstruction's boundary, over D.
  // Distance from the surface to the reconstruction, over D. The maximum is searched and is at most 1e-5 D too small.
  Spread coverage;
  // Proven up to rounding: no place of the surface is farther than this from the reconstruction.
  double coverage_upper = 0;
  // The coverage without the places at the borders of sheets, where pruning removes parts. NaN if the mesh has neither
  // edges nor triangles, because every ball is a border then.
  Spread inner_coverage;
  Spread protrusion;  // Distance from places of the reconstruction outside the solid to the solid, over D.
  // Proven up to rounding: no ball extends farther than this beyond the place of the surface that is nearest to its
  // centre. It is larger than the protrusion where a ball closes a crevice.
  double protrusion_upper = 0;
  // Proven: no place of the reconstruction's boundary is deeper inside the solid than this.
  double dent_upper = 0;
  Spread radius_error;  // |radius - distance to the surface| of vertices, over D.
  // |distance to the second contact - radius| of vertices, over the radius. NaN if no vertex has a second contact.
  Spread centredness;
  // The fractions of the vertices, edges and triangles that lie outside the solid by more than 1e-9 D.
  double outside_vertices = 0, outside_edges = 0, outside_triangles = 0;
  Topology found, wanted;  // Of the medial mesh, and of the solid.
  Economy economy;
  Index balls = 0;           // The number of vertices of the medial mesh.
  double border_length = 0;  // border_length() over D.
  MedialPieces pieces;
  // The worst places with a value above 1e-6: those of protrusion first, then those of coverage, each from the worst
  // down.
  std::vector<WorstPlace> worst;
};

// Measures a medial mesh against a solid. Throws InputError unless surface.solid() and validate(mesh) passes. The
// result is deterministic for a seed; the work is parallel.
MedialQuality medial_quality(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options = {},
                             const Progress& progress = {});

// Errors of single balls of an axis. Lengths are over the diagonal of the surface's bounding box.
struct BallErrors {
  std::vector<double> radius_error, protrusion;
  // Over the radius. NaN where there is no second contact or the radius is almost zero.
  std::vector<double> centredness;
};
// Measures each ball by the definitions of medial_quality(). If options.contact_cells is 0, the centredness, which
// takes longest, is not measured. Throws InputError unless surface.solid(). The work is parallel.
BallErrors ball_errors(const Surface& surface, std::span<const Sphere> balls, const QualityOptions& options = {});

// Returns the protrusion of each ball only.
std::vector<double> ball_protrusions(const Surface& surface, std::span<const Sphere> balls);

// Errors of the reconstruction at single points of the surface, over the diagonal.
struct SurfaceErrors {
  std::vector<double> coverage, protrusion;
};
// Measures the reconstruction at each point by the definitions of medial_quality(). `normals` are outward and of unit
// length. Throws InputError unless surface.solid(). The work is parallel.
SurfaceErrors surface_errors(const Surface& surface, const MedialMesh& mesh, std::span<const Point> points,
                             std::span<const Vector> normals);

// The noise of medial_stability(). It is a smooth random field: independent displacements on a lattice, interpolated in
// between. The field does not depend on the triangles of the mesh; triangles that are too long for the lattice are
// divided. So the result depends on the solid and not on the fineness of its mesh, and the noise does not crumple a
// mesh with small triangles.
struct StabilityOptions {
  double noise = 0.001;  // The largest displacement of any place of the surface, over the diagonal.
  // The spacing of the lattice over the diagonal, above 0. Places that are farther apart than this move independently.
  double correlation = 0.05;
  // Half the angle between the contacts, in radians; 60 degrees by default. Only parts of the axis with a larger object
  // angle are compared.
  double object_angle = 1.0472;
  std::uint64_t seed = 1;
};

// Distances between two axes, from the vertices of each one to the other, over the amplitude of the noise.
struct MedialStability {
  double hausdorff = 0, percentile99 = 0, mean = 0;
};

// Measures how much the medial axis moves under noise. It compares the axis in `build` with the axis of the mesh with
// noise, which is built with `options` from the same points. These points, including those that were added to the
// sampling, move with the mesh. Only the part with an object angle above stability.object_angle is compared, with the
// part of the other axis whose object angle is at most 10 degrees smaller.
// Returns nullopt if the perturbed mesh is not a solid, or if one of the axes has no such part.
std::optional<MedialStability> medial_stability(const Surface& surface, const MedialBuild& build,
                                                const MedialBuildOptions& options,
                                                const StabilityOptions& stability = {}, const Progress& progress = {});

// Returns, for each vertex of the surface's mesh, the radius of the largest ball that touches it, among the balls of
// the vertices of `mesh`. This is half the local thickness. A ball touches a vertex if its distance is at most 0.001
// bounding radii above that of the nearest ball.
std::vector<double> medial_radii_at_surface(const Surface& surface, const MedialMesh& mesh);

}  // namespace orchard
