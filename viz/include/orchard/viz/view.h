#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/medial/medial_mesh.h"
#include "orchard/spheretree/tree.h"
#include "orchard/viz/render.h"
#include "orchard/voronoi/diagram.h"

// Pictures of files: whatever they hold, in the look of the pipeline's picture, one in the other. The rules of render.h
// hold.
namespace orchard {

template <class Value>
struct Named {
  std::string name;  // for the caption
  Value value;
};

struct Scene {
  std::vector<Named<Surface>> meshes;
  std::vector<Named<SphereTree>> trees;
  std::vector<Named<MedialMesh>> axes;
  std::vector<Named<VoronoiDiagram>> diagrams;  // cells, by inaccuracy if they have any, cut open; a panel each
  std::vector<Named<std::vector<Point>>> points;
  // Of the trees, a panel for each; below a tree's deepest: its leaves. Empty: the deepest one there is.
  std::vector<Index> levels;
  double opacity = 0.16;  // of meshes, where there is something else to see
};

// Draws a .png. Of `picture`, all but the values counts.
PictureStatus draw_view(const std::filesystem::path& png, const Scene& scene, const PipelinePicture& picture);

// Opens a window on $DISPLAY and returns once it is closed. Keys: up, down and digits for the level, o and O for the
// opacity of meshes, s to save what is seen to `png` (unless that is empty), r to see all again, q to close; a click on
// a sphere prints its record to standard output. picture.timeout and picture.progress do not count. A status that is
// not made says why there was no window.
PictureStatus show_view(const std::filesystem::path& png, const Scene& scene, const PipelinePicture& picture);

}  // namespace orchard
