#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/medial/axis.h"

namespace orchard {

// A medial axis as the medial-mesh community has it (Li, Wang, Sun, Hu 2015): balls, and edges and triangles between
// them that stand for the balls in between, whose centres and radii are interpolated linearly. Any system's result.
struct MedialMesh {
  std::vector<Point> centers;
  std::vector<double> radii;                    // >= 0
  std::vector<std::array<Index, 2>> edges;      // ascending, each once; those of the triangles included
  std::vector<std::array<Index, 3>> triangles;  // each ascending, each once

  Index size() const { return static_cast<Index>(centers.size()); }
};

// The whole axis, walls included, so that the result has its topology. Faces are cut into fans from a corner whose
// diagonals are no edges yet, or from a new vertex at the face's middle where there is no such corner.
MedialMesh medial_mesh(const MedialAxis& axis);

// Sorts edges and triangles, drops repeated ones and adds the edges of triangles.
void complete(MedialMesh& mesh);

// Throws InputError, which names the first fault, unless the mesh is complete, indices are in range, corners distinct,
// coordinates finite and radii finite and not negative, and there is a vertex.
void validate(const MedialMesh& mesh);

// The .ma format: a line "nv ne nf", then lines "v x y z r", "e i j" and "f i j k", counted from 0 (docs/FORMATS.md).
// Numbers are the shortest that read back the same.
std::string to_ma(const MedialMesh& mesh);
// Lines that start with '#' and text after what is needed on a line are skipped. The result is complete and valid.
// Throws InputError, which names file and line.
MedialMesh read_ma(const std::filesystem::path& file);

}  // namespace orchard
