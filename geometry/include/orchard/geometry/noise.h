#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"

// Estimates the noise of a scanned mesh and removes it. Noise is a displacement of each vertex along the normal of the
// surface, independent of those of its neighbours. Its deviation is the standard deviation of that displacement, as a
// fraction of the diagonal of the mesh's bounding box.
namespace orchard {

// The largest deviation that denoise() accepts. In meshes with more noise, triangles lie folded over their neighbours.
inline constexpr double kMaxNoise = 0.05;

// Returns the deviation of the noise of a mesh: the median, over the vertices, of the standard deviation of the
// vertices around each one from the cubic surface that fits them best. Sharp edges do not change the median as long as
// most vertices lie away from them. What a mesh shows between its vertices counts as noise if it is too coarse to be
// told from it: about 0.0003 for a smooth body of 6,000 triangles. Returns 0 if a tenth of the edges or more are flat,
// which noise leaves none of, as on designed parts; and if fewer than half of the vertices have enough neighbours for a
// fit. O(n); parallel, and the same for any number of threads. Precondition: validate(mesh).
double noise_deviation(const TriangleMesh& mesh);

// The options of denoise().
struct DenoiseOptions {
  double deviation = 0;  // The deviation of the noise, 0..kMaxNoise. 0 leaves the mesh as it is.
  // The maximum number of rounds, at least 0. A round filters the normals once and moves the vertices three times.
  int max_rounds = 50;
};

// A mesh without its noise, and how far it is from the mesh that was given. Lengths are fractions of the diagonal.
struct DenoisedMesh {
  TriangleMesh mesh;  // The given triangles, with other vertices.
  int rounds = 0;
  double moved_rms = 0;  // The root mean square of the vertices' displacements along their normals.
  double moved_max = 0;  // The largest displacement of a vertex in any direction, at most three deviations.
};

// Removes noise of a known deviation. The normals of triangles become the average of those around them, weighted by
// area, by distance and by how alike they are, so that sharp edges stay sharp; then the vertices move to fit the
// normals (Zheng, Fu, Au, Tai 2011; Sun, Rosin, Martin, Langbein 2007). Rounds end when the vertices have moved as far
// as the noise has, in the root mean square: more smoothing would remove what is not noise (the discrepancy principle
// of Morozov). No vertex moves by more than three deviations. The mesh keeps its triangles and so its topology, but may
// cut itself where the noise is as large as a part is thick. Throws InputError if an option is out of range, and
// Cancelled if `progress` returns false. O(n) for each round; parallel, and the same for any number of threads.
// Precondition: validate(mesh).
DenoisedMesh denoise(const TriangleMesh& mesh, const DenoiseOptions& options, const Progress& progress = {});

}  // namespace orchard
