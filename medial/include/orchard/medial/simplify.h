#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/quality.h"

// Reduces a medial mesh to few balls whose envelope is as near to the surface as that number of balls allows. The
// envelope is the boundary of the reconstruction, which is the union of the balls, cones and slabs of the mesh's
// vertices, edges and triangles.
namespace orchard {

// The balls that a simplified axis may have.
enum class SimplifiedBalls : std::uint8_t {
  // Centres lie in the solid or on its surface, and radii differ from the centre's distance to the surface by at most
  // the two-sided distance. The result aims at the volume of the solid.
  medial,
  // The balls that fit best. A part that is too thin for the number of balls may get balls with centres outside.
  free
};

// The options of simplify_medial_mesh().
struct SimplifyOptions {
  // The maximum number of vertices. 0 asks for the smallest number that `error` allows, which is found to within 2 %.
  Index vertices = 0;
  // If `vertices` is 0: the largest two-sided distance that is allowed, over the diagonal, above 0. The result is
  // proved to keep it.
  double error = 0;
  Index samples = 10'000;  // Places of the surface that the balls are fitted to.
  Index check = 20'000;    // Places from which the distance is measured at the end.
  // The maximum number of parts that each search for dents and protrusions examines.
  Index search = 1'000'000;
  SimplifiedBalls balls = SimplifiedBalls::medial;
  // The maximum number of rounds that move vertices from places where they are dispensable to the place of the largest
  // distance.
  int rounds = 4;
  std::uint64_t seed = 1;
};

// Measures of the simplified mesh.
struct SimplifyReport {
  Index vertices_before = 0, vertices = 0;
  // Measured on the result as medial_quality() defines them, over the diagonal. coverage.max is a bound that is proved
  // for the whole surface, and hausdorff.max is at least as large. Branch and bound searches for protrusions, and for
  // dents of the envelope, where they may exceed that value; the search for dents also starts at the centres of the
  // balls of the given mesh. How deep places of the surface lie in the reconstruction is measured at samples.
  // protrusion.max is the largest value that was found.
  Spread hausdorff, coverage, protrusion;
  // A proved bound, over the diagonal: no place of the surface is farther from the reconstruction, and no place of the
  // envelope is farther from the surface. It is at least hausdorff.max, and exceeds it by at most 2 % or
  // 1e-4 unless a search was cut short or a ball closes a crevice. If options.error is in force, values below
  // options.error are not searched for, so this bound is then not much below options.error.
  double upper = 0;
};

// The result of simplify_medial_mesh().
struct SimplifiedMedialMesh {
  MedialMesh mesh;
  SimplifyReport report;
};

// Simplifies a medial mesh in these steps:
// 1. Edges are contracted under the link condition, which keeps the Betti numbers of `mesh`, until options.vertices are
//    left. The first contractions are chosen by quadrics of slabs, cones and borders, the later ones by the cost at
//    places of the surface. In between and at the end, all balls are fitted to the surface, within options.balls.
// 2. Vertices are moved from places where they are dispensable to the place of the largest distance.
// A single vertex becomes the largest ball in the solid. Radii may be 0 on edges. If options.balls is `medial`, the
// mesh is contracted twice, once with free and once with medial balls, each time also to the next half-power of 2 below
// options.vertices, and the nearest result is returned. So more vertices are seldom worse than fewer, and never worse
// than that next lower number.
//
// Throws InputError
// - unless surface.solid(), validate(mesh) passes and the options are in range;
// - if the topology needs more vertices than options.vertices: the message names the lowest number that was reached,
//   and the number that is proved to be needed if it is lower;
// - if no number of vertices reaches options.error: the message names the error that was reached.
// The result is deterministic on any number of threads; the work is parallel. Takes O(n log n) for n vertices, and
// several nearest-ball queries for each sample.
SimplifiedMedialMesh simplify_medial_mesh(const Surface& surface, const MedialMesh& mesh,
                                          const SimplifyOptions& options, const Progress& progress = {});

// Simplifies a mesh to each of several numbers of vertices (descending) in one descent; options.vertices and
// options.error are ignored. No result is worse than one with fewer vertices. The results end before the first number
// that the topology does not allow.
std::vector<SimplifiedMedialMesh> simplify_to_each(const Surface& surface, const MedialMesh& mesh,
                                                   std::span<const Index> vertices, const SimplifyOptions& options,
                                                   const Progress& progress = {});

// Returns the largest ball inside the solid that ascent of the distance to the surface reaches from the largest balls
// of `mesh`. Throws InputError unless surface.solid().
Sphere max_inscribed_ball(const Surface& surface, const MedialMesh& mesh);

}  // namespace orchard
