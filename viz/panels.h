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

// What orchard-render draws: one panel per stage of the pipeline.
namespace orchard::detail {

// A ball that the camera must keep in view; radius 0 for a point.
struct Extent {
  std::array<double, 3> center;
  double radius;
};

// A word on top of a place, where the place faces the eye.
struct Label {
  std::array<double, 3> position, outward;
  std::string text;
};

struct Panel {
  vtkSmartPointer<vtkRenderer> renderer;  // without a camera
  std::string caption, detail;            // a name, and figures in smaller print
  bool from_behind = false;               // the camera is on the other side of the model
  std::vector<Label> labels = {};
};

struct Panels {
  std::vector<Panel> panels;
  std::vector<Extent> extents;  // of everything, so that all panels share one camera
  double size = 1;              // a length of the model's order
  int columns = 0;              // of panels; 0: as many as fit
  // Draws what the colours of all panels stand for, in so many pixels; empty: nothing that needs saying.
  std::function<vtkSmartPointer<vtkRenderer>(int width, int height)> color_bar = {};
};

struct PanelOptions {
  double line_width = 1;             // of the model's edges, in pixels
  std::array<double, 3> backward{};  // a unit vector towards the eye
  double opacity = 0.16;             // of meshes, where a scene has more than them
  bool whole = false;                // Voronoi cells are not cut open: their box does so
  FigureOptions figure = {};         // of a scene
};

// Panels for the files that a .vtm of write_pipeline() opens, by the names that it gives them; where there is a block
// "medial mesh", of where that is bad instead; of a scene of view.h, that. Throws std::runtime_error if the .vtm cannot
// be read.
Panels make_panels(const std::filesystem::path& vtm, const PanelOptions& options);

}  // namespace orchard::detail
