#pragma once
#include <array>
#include <filesystem>
#include <optional>
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

// What a figure shows besides, and how.
struct Figure {
  // An array of the points or cells of axes (radius, structure, structure_kind), trees' levels (write_tree_level) or
  // .vtp files, with a bar of its colours where it is a quantity. Empty: axes by radius, trees by branch, without a
  // bar.
  std::string color = {};
  std::optional<std::array<double, 2>> range = {};  // of the colours; nothing: that of all values
  std::optional<Point> look_at = {};                // the middle of the picture; nothing: of everything
  double span = 0;                                  // of what is seen around it, in mesh units; 0: everything
  std::optional<std::array<double, 4>> clip = {};   // a, b, c, d: what has a x + b y + c z > d is cut away
  bool edges = false;        // borders (dark) and seams (orange) of axes, feature edges of .vtp files
  bool balls = false;        // the balls of axes instead of their sheets
  bool beside = false;       // a panel for each thing, with the meshes around it, not all of them in one
  bool captions = true;      // below the panels
  bool transparent = false;  // no white ground
  bool steady = false;       // room for everything from all directions, for turntables
};

struct Scene {
  std::vector<Named<Surface>> meshes;
  std::vector<Named<SphereTree>> trees;
  std::vector<Named<MedialMesh>> axes;
  std::vector<Named<VoronoiDiagram>> diagrams;  // cells, by inaccuracy if they have any, cut open; a panel each
  std::vector<Named<std::vector<Point>>> points;
  std::vector<Named<std::filesystem::path>> data;  // .vtp files, as they are
  // Of the trees, a panel for each; below a tree's deepest: its leaves. Empty: the deepest one there is.
  std::vector<Index> levels;
  double opacity = 0.16;  // of meshes, where there is something else to see
  Figure figure;          // of draw_view(); a window has keys for what it can do
};

// The arrays that Figure::color may name, in alphabetical order. Reads the heads of the scene's .vtp files; those that
// cannot be read have none.
std::vector<std::string> color_arrays(const Scene& scene);

// Draws a .png. Of `picture`, all but the values counts.
PictureStatus draw_view(const std::filesystem::path& png, const Scene& scene, const PipelinePicture& picture);

// Opens a window on $DISPLAY and returns once it is closed. Keys: up, down and digits for the level, o and O for the
// opacity of meshes, s to save what is seen to `png` (unless that is empty), r to see all again, q to close; a click on
// a sphere prints its record to standard output. picture.timeout and picture.progress do not count. A status that is
// not made says why there was no window.
PictureStatus show_view(const std::filesystem::path& png, const Scene& scene, const PipelinePicture& picture);

}  // namespace orchard
