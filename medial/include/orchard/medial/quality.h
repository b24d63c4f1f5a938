#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"

namespace orchard {

// How good a medial mesh is for a solid, whichever system made it. docs/medial-quality.md defines each metric and says
// what is perfect. The reconstruction is the union of the balls, cones and slabs of its vertices, edges and triangles.

struct QualityOptions {
  Index surface_samples = 100'000;  // for coverage and protrusion
  Index cells = 200'000;            // of each kind (vertices, edges, triangles) that are looked at, evenly chosen
  Index contact_cells = 10'000;     // vertices whose second contact is searched
  double contact_angle = 0.5235987755982988;  // radians, 30 degrees: half the opening of the first contact's cone
  double economy_error = 0.01;                // of the diagonal
  Index economy_candidates = 20'000, economy_samples = 20'000;
  std::uint64_t seed = 1;
};

struct Spread {
  double max = 0, mean = 0;
};

struct Economy {
  Index spheres = 0;     // that a greedy cover needs
  double uncovered = 0;  // fraction of the samples that no admissible ball reaches
};

struct MedialQuality {
  double diagonal = 0;  // D of the mesh's bounding box, in mesh units
  Spread coverage;      // distance from the surface to the reconstruction, over D
  Spread protrusion;    // distance of the reconstruction outside the solid, over D
  Spread radius_error;  // |radius - distance to the surface| of vertices, over D
  Spread centredness;   // |distance to the second contact - radius| of vertices, over the radius
  double outside_vertices = 0, outside_edges = 0, outside_triangles = 0;  // fractions
  Topology found, wanted;                                                 // of the medial mesh; of the solid
  Economy economy;
};

// Deterministic for a seed; parallel. Throws InputError unless surface.solid() and validate(mesh) passes.
MedialQuality medial_quality(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options = {},
                             const Progress& progress = {});

struct StabilityOptions {
  double noise = 0.001;          // every vertex moves by at most this, in diagonals
  double object_angle = 1.0472;  // radians, 60 degrees: half the angle between the contacts
  std::uint64_t seed = 1;
};

// Distances between two axes, from the vertices of each to the other, over the noise.
struct MedialStability {
  double hausdorff = 0, percentile99 = 0, mean = 0;
};

// Of the medial axis of the mesh and that of the mesh with noise, both built with `options`; only what has a larger
// object angle is compared (with what has one at most 10 degrees smaller).
// Nothing if the noise makes the mesh no solid, or if an axis has no such part.
std::optional<MedialStability> medial_stability(const Surface& surface, const MedialBuild& build,
                                                const MedialBuildOptions& options,
                                                const StabilityOptions& stability = {}, const Progress& progress = {});

// The radius of the largest ball that touches each vertex of the surface's mesh, of those of `mesh`'s vertices: the
// local thickness, halved. A ball touches if it comes as near as the nearest, up to 0.001 bounding radii.
std::vector<double> medial_radii_at_surface(const Surface& surface, const MedialMesh& mesh);

}  // namespace orchard
