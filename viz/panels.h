#pragma once
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "figure.h"

// The panels that orchard-render draws: one for each stage of the pipeline.
namespace orchard::detail {

// A ball that the camera must keep in view; radius 0 for a point.
struct Extent {
  std::array<double, 3> center;
  double radius;
};

// A word that is drawn on top of a place if the place faces the eye.
struct Label {
  std::array<double, 3> position, outward;
  std::string text;
};

struct Panel {
  vtkSmartPointer<vtkRenderer> renderer;  // it has no camera yet
  std::string caption, detail;            // a name, and values in smaller print
  bool from_behind = false;               // the camera is on the other side of the model
  std::vector<Label> labels = {};
};

struct Panels {
  std::vector<Panel> panels;
  std::vector<Extent> extents;  // of everything, because all panels share one scale
  double size = 1;              // the order of magnitude of the model's size
  int columns = 0;              // of the arrangement of panels; 0 for as many as fit
  // Draws the legend of the colours of all panels, in this size in pixels. Empty if no legend is needed.
  std::function<vtkSmartPointer<vtkRenderer>(int width, int height)> color_bar = {};
};

struct PanelOptions {
  double line_width = 1;             // of the model's edges, in pixels
  std::array<double, 3> backward{};  // a unit vector towards the eye
  double opacity = 0.16;             // of meshes in a scene that has other things, too
  bool whole = false;                // whether Voronoi cells are not cut open, because their box cuts them
  FigureOptions figure = {};         // the options of a scene
};

// Makes panels for the files that a .vtm of write_pipeline() opens, by the names that it gives to them. If there is a
// block "medial mesh", the panels show where that axis is worst, and for a scene of view.h, they show the scene. Throws
// std::runtime_error if the .vtm cannot be read.
Panels make_panels(const std::filesystem::path& vtm, const PanelOptions& options);

}  // namespace orchard::detail
