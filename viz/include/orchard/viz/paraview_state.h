#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/viz/vtk_writer.h"

// States of ParaView (5.11 or later): files, how each of them is shown and in which views. They open by a double click.
namespace orchard {

// How a file is shown.
struct StateLayer {
  enum class Look {
    surface,  // polygons, and lines of `width`
    spheres,  // one at each point
    edges     // the outlines of all polygons, in `width`
  };

  std::string name = {};            // in ParaView's list of sources
  std::filesystem::path file = {};  // .vtp, .vtu or .pvd; relative to the state's folder
  Look look = Look::surface;
  std::string array = {};    // that the colour stands for; empty: `color`
  bool of_cells = false;     // whether `array` is one of cells, not of points
  bool categories = false;   // whether its values are numbers of things, each with a colour of its own
  double sphere_radius = 0;  // of all spheres, in mesh units; 0: what the point array `radius` says
  double width = 1;          // of lines, in pixels
  double opacity = 1;        // 0 to 1
  std::array<double, 3> color{0.55, 0.62, 0.70};  // red, green, blue, 0 to 1
};

// Of the values of an array: the colours go from one to the other, in all views alike.
struct StateRange {
  std::string array = {};
  std::array<double, 2> range{0, 1};
  std::string title = {};  // of the legend; empty: none is shown
};

struct StateView {
  std::string title = {};                // above what is shown; may be empty
  std::vector<std::size_t> layers = {};  // that are shown, by their places in StateScene::layers
};

struct StateScene {
  std::vector<StateLayer> layers;  // all of them are in ParaView's list, shown or not
  std::vector<StateRange> ranges;  // one for each array that colours stand for
  std::vector<StateView> views;    // side by side, 1 to 16 of them; they turn together
  Point center = Point::Zero();    // what is looked at: a ball
  double radius = 1;
  UpAxis up = UpAxis::y;  // the axis that points up
  // Files in time (.pvd) are shown at this step, with the colours of each step's range.
  std::optional<Index> last_step = {};
};

// Writes it as a whole or not at all; throws Error if it cannot be written. States name their files absolutely:
// `folder` is where those of the layers will be. The same bytes for the same values.
void write_paraview_state(const std::filesystem::path& pvsm, const StateScene& scene,
                          const std::filesystem::path& folder);

}  // namespace orchard
