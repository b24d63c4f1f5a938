#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/spheretree/tree.h"
#include "orchard/viz/render.h"
#include "orchard/voronoi/diagram.h"

// Draws any combination of meshes, axes, trees, diagrams and points, in the style of the pipeline's picture, or shows
// them in a window. The rules of render.h hold.
namespace orchard {

// A value with its name.
template <class Value>
struct Named {
  std::string name;  // The caption.
  Value value;
};

// What a figure shows and how.
struct Figure {
  // The array that determines the colours: an array of the points or cells of axes (radius, structure, structure_kind),
  // of tree levels (write_tree_level) or of .vtp files. A quantity gets a colour bar. If this is empty, axes are
  // coloured by radius and trees by branch, without a bar.
  std::string color = {};
  // The title of the colour bar; if it is empty, the name of the array.
  std::string bar_title = {};
  // The map from values to colours: one of color_map_names().
  std::string map = "viridis";
  // The range of the colours; without a value, the range of all values.
  std::optional<std::array<double, 2>> range = {};
  std::optional<Point> look_at = {};  // The middle of the picture; without a value, the middle of everything.
  double span = 0;                    // The extent that is shown, in mesh units; 0 shows everything.
  std::optional<std::array<double, 4>> clip = {};  // a, b, c, d: parts with a x + b y + c z > d are cut away.
  std::optional<Box> room = {};  // A box that must fit into the picture beside the items: for pictures of a series.
  bool edges = false;            // Borders (black) and seams (orange) of axes, and feature edges of .vtp files.
  bool balls = false;            // The balls of axes instead of their sheets.
  bool beside = false;           // A panel for each item, with the meshes around it, instead of one panel for all.
  bool captions = true;          // Captions below the panels.
  bool transparent = false;      // No white background.
  bool steady = false;           // Enough room for all items from all directions, for turntables.
};

// The items of a picture.
struct Scene {
  std::vector<Named<Surface>> meshes;
  std::vector<Named<SphereTree>> trees;
  std::vector<Named<MedialMesh>> axes;
  std::vector<Named<VoronoiDiagram>> diagrams;  // Cells, cut open, coloured by inaccuracy if any; a panel each.
  std::vector<Named<std::vector<Point>>> points;
  // .vtp and .vtu files, unchanged. Points alone are dots, or spheres if they have an array `radius`.
  std::vector<Named<std::filesystem::path>> data;
  // The levels of the trees, with a panel for each. A level below the deepest one of a tree shows its leaves. If this
  // is empty, the deepest level is shown.
  std::vector<Index> levels;
  double opacity = 0.16;  // The opacity of meshes if there are other items.
  Figure figure;          // Used by draw_view(); a window has keys for what it can show.
};

// Returns the arrays that Figure::color may name, in alphabetical order. Reads the heads of the scene's .vtp files;
// files that cannot be read have no arrays.
std::vector<std::string> color_arrays(const Scene& scene);

// Returns the names that Figure::map may have. The lightness of each map rises or falls from one end to the other, also
// for colour-blind eyes.
std::vector<std::string> color_map_names();

// Returns the bounding box of .vtp and .vtu files, radii included where points are spheres. Files that cannot be read
// add nothing.
Box bounds_of_data(const std::vector<std::filesystem::path>& files);

// Draws a .png file, or a picture of lines: .svg or .pdf. Uses all members of `picture` except the values. A picture of
// lines has the outlines and sharp edges of meshes and spheres, the borders, seams and curves of axes, and captions as
// text; what is hidden is left out, and its sizes are points in place of pixels. It needs no display, ignores the
// colours of the figure, and cannot show Voronoi diagrams.
PictureStatus draw_view(const std::filesystem::path& picture_file, const Scene& scene, const PipelinePicture& picture);

// Opens a window on $DISPLAY and returns when it is closed. A status without a picture states why there was no window.
// Ignores picture.timeout and picture.progress.
// Keys: up, down and digits select the level, o and O change the opacity of meshes, s saves the view to `png` (unless
// that is empty), r shows everything again, q closes the window. A click on a sphere prints its record to standard
// output.
PictureStatus show_view(const std::filesystem::path& png, const Scene& scene, const PipelinePicture& picture);

}  // namespace orchard
