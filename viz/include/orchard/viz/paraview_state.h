#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/viz/vtk_writer.h"

// Writes states of ParaView (5.11 or later). A state describes files, how each of them is shown and in which views. It
// opens by a double click.
namespace orchard {

// A file, and how it is shown.
struct StateLayer {
  // How the contents of a file are drawn.
  enum class Look {
    surface,  // Polygons, and lines of `width`.
    spheres,  // A sphere at each point.
    edges     // The outlines of all polygons, in `width`.
  };

  std::string name = {};            // The name in ParaView's list of sources.
  std::filesystem::path file = {};  // A .vtp, .vtu or .pvd file; relative to the folder of the state.
  Look look = Look::surface;
  std::string array = {};   // The array that determines the colour; if it is empty, `color` does.
  bool of_cells = false;    // Whether `array` is an array of cells, otherwise of points.
  bool categories = false;  // Whether its values are numbers of things, each of which gets its own colour.
  // The radius of all spheres, in mesh units; 0 uses the point array `radius`.
  double sphere_radius = 0;
  double width = 1;                               // The width of lines, in pixels.
  double opacity = 1;                             // In 0..1.
  std::array<double, 3> color{0.55, 0.62, 0.70};  // Red, green and blue, each in 0..1.
};

// The range of the values of an array. The colours span this range in all views.
struct StateRange {
  std::string array = {};
  std::array<double, 2> range{0, 1};
  std::string title = {};  // The title of the legend; if it is empty, there is no legend.
};

// A view of some of the layers.
struct StateView {
  std::string title = {};                // The title above the view; may be empty.
  std::vector<std::size_t> layers = {};  // The layers that are shown, as indices into StateScene::layers.
};

// A whole state.
struct StateScene {
  std::vector<StateLayer> layers;  // All of them are in ParaView's list, shown or not.
  std::vector<StateRange> ranges;  // One for each array that determines colours.
  std::vector<StateView> views;    // 1 to 16 views side by side, which turn together.
  Point center = Point::Zero();    // The centre of the ball that the views show.
  double radius = 1;               // The radius of this ball, in mesh units.
  UpAxis up = UpAxis::y;           // The axis that points up.
  // Time series (.pvd) are shown at this step, with the colours of each step's range.
  std::optional<Index> last_step = {};
};

// Writes a state completely or not at all. `folder` is the absolute folder where the files of the layers will be,
// because states contain absolute file names. The same values give the same bytes. Throws Error if the file cannot be
// written.
void write_paraview_state(const std::filesystem::path& pvsm, const StateScene& scene,
                          const std::filesystem::path& folder);

}  // namespace orchard
