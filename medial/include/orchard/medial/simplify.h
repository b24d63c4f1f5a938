#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/quality.h"

namespace orchard {

// The medial mesh in as few balls as you like: its envelope, the union of the balls, cones and slabs of its vertices,
// edges and triangles, stays as near to the surface as so many can.
// What balls of a simplified axis may be. Free ones are those that fit best: a part too thin for so few balls is given
// some whose centres lie outside.
enum class SimplifiedBalls : std::uint8_t {
  medial,  // centres in the solid, or on its surface; radii off the centre's distance to the surface by no more than
           // the two-sided distance; and the solid's volume is aimed at
  free
};

struct SimplifyOptions {
  Index vertices = 0;        // at most so many; 0: as few as `error` allows, to a fiftieth
  double error = 0;          // where vertices is 0: the two-sided distance allowed, over the diagonal, proved; above 0
  Index samples = 10'000;    // places of the surface that balls are fitted to
  Index check = 20'000;      // places from which the distance is measured at the end
  Index search = 1'000'000;  // parts at most in which dents and what protrudes are searched, each time
  SimplifiedBalls balls = SimplifiedBalls::medial;
  int rounds = 4;  // at most, of moving vertices from where they are spared to where the distance is largest
  std::uint64_t seed = 1;
};

struct SimplifyReport {
  Index vertices_before = 0, vertices = 0;
  // Measured on the result, over the diagonal, as medial_quality() defines them. coverage.max is a bound, proved for
  // the whole surface, and hausdorff.max no less; what protrudes, and dents of the envelope, are searched by branch and
  // bound where they may be more than that, dents from the centres of the balls of the mesh given, too; how deep places
  // of the surface lie in the envelope is measured at samples. protrusion.max is what was found.
  Spread hausdorff, coverage, protrusion;
  // Proved, over the diagonal: no place of the surface is farther from the envelope, none of the envelope's boundary
  // from the surface. At least hausdorff.max; 2 % or 1e-4 more, unless the searches did not come to their end, or a
  // ball closes a crevice. Where options.error counts, what is less than it is not
  // searched for, and this is no less than nearly so much.
  double upper = 0;
};

struct SimplifiedMedialMesh {
  MedialMesh mesh;
  SimplifyReport report;
};

// Contracts edges under the link condition, and so keeps the Betti numbers of `mesh`, until options.vertices are left:
// first by quadrics of slabs, cones and borders, then by what contracting costs places of the surface; fits all balls
// to the surface in between and at the end; then moves vertices from where they are spared to where the distance is
// largest. One vertex alone is the largest ball in the solid. Radii may be 0, on edges. Balls are those that fit best
// among those that options.balls allows. Where these are medial, the mesh goes down twice, by contractions that make
// free balls and by ones that make medial ones, each time to the next half-power of 2 below options.vertices as well,
// and the nearest result is taken: more vertices are seldom worse than fewer, and never worse than that number below.
//
// Deterministic, whatever the number of threads; parallel. O(n log n) for n vertices, and some nearest-ball queries for
// each sample. Throws InputError unless surface.solid(), validate(mesh) passes and options are in range; if no
// contraction leads to so few vertices, since the topology needs more: the error names the least number that was
// reached, and that which is proved to be needed if it is less; or if no number of vertices leads to options.error: it
// names what was reached.
SimplifiedMedialMesh simplify_medial_mesh(const Surface& surface, const MedialMesh& mesh,
                                          const SimplifyOptions& options, const Progress& progress = {});

// The same for each of several numbers of vertices, which are descending, all from the same descents; options.vertices
// and .error do not count. None is farther off than one of fewer vertices. Ends before the first that the topology does
// not allow.
std::vector<SimplifiedMedialMesh> simplify_to_each(const Surface& surface, const MedialMesh& mesh,
                                                   std::span<const Index> vertices, const SimplifyOptions& options,
                                                   const Progress& progress = {});

// The largest ball inside the solid that lies uphill, on the distance to the surface, from the largest balls of `mesh`.
// Throws InputError unless surface.solid().
Sphere max_inscribed_ball(const Surface& surface, const MedialMesh& mesh);

}  // namespace orchard
