#pragma once
#include <chrono>
#include <filesystem>
#include <string>

#include "orchard/geometry/progress.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/quality.h"
#include "orchard/viz/vtk_writer.h"

// Draws pictures of the pipeline. Debian's VTK draws only on an X display, even offscreen, and aborts the process if
// there is no display or its OpenGL does not work. So a small separate program, `orchard-render`, draws the files of
// write_pipeline(), and the caller gets a status whatever happens to that program. (Drawing in a forked copy of the
// caller would be unsafe beside the threads of TBB and Embree.)
namespace orchard {

// The contents and the layout of a picture.
struct PipelinePicture {
  // The values to draw: mesh, points, medial axis and three tree levels. Missing values get no panel.
  PipelineValues values;
  std::string title;      // The title above the panels; may be empty.
  UpAxis up = UpAxis::y;  // The axis of the mesh that points up in the picture.
  // The position of the eye, in radians: the azimuth from the front of the model (z; -y if z is up) towards its right,
  // and the elevation above its middle.
  double azimuth = 0.6, elevation = 0.4;
  int width = 0;                      // In pixels, 64 to 8192; 0 is as wide as the model and its captions need.
  int height = 0;                     // In pixels, 64 to 8192; 0 is 560 for each row of panels.
  std::chrono::seconds timeout{120};  // The time limit for drawing; a picture takes a few seconds.
  // The path of orchard-render. If it is empty, $ORCHARD_RENDER, the folder of the running program and PATH are
  // searched in this order.
  std::filesystem::path renderer;
  // Called every few milliseconds, without a meaningful fraction, so that a picture can be cancelled.
  Progress progress;
};

// Whether a picture was made.
struct PictureStatus {
  bool made = false;
  std::string reason;  // Why there is no picture, in one line.
  explicit operator bool() const { return made; }
};

// Returns a line that states why nothing can be drawn and what to do, if orchard-render does not exist or cannot be
// run; otherwise an empty string.
std::string renderer_missing(const PipelinePicture& picture = {});

// Draws a .png file. Uses the display of $DISPLAY; if that is unset or does not work, starts Xvfb from PATH for the
// duration of the drawing. A missing display, renderer, writable file or time gives a status and no exception. The
// function throws Cancelled only, prints nothing, and leaves neither processes nor temporary files behind. It may be
// called from several threads.
PictureStatus draw_pipeline(const std::filesystem::path& png, const PipelinePicture& picture);

// A medial axis and its errors.
struct MedialErrorsOfAxis {
  std::string name = {};  // The caption, if the picture shows several axes; "this axis" is the first one.
  const MedialMesh* mesh = nullptr;
  std::vector<double> coverage;  // For each point, in % of the diagonal.
  // For each vertex of the medial mesh, the largest protrusion of the balls around it, in % of the diagonal.
  std::vector<double> protrusion;
  std::vector<WorstPlace> worst;  // The worst places, numbered from 1.
};

// The values of a picture of the errors of medial axes of one solid.
struct MedialErrorsPicture {
  const Surface* surface = nullptr;
  const SurfaceSampling* sampling = nullptr;  // The surface points at which coverage is shown.
  std::vector<MedialErrorsOfAxis> axes;       // One row of panels each; there is at least one.
};

// Draws the surface coloured by coverage and the axis coloured by protrusion, each from the front and from behind, with
// the numbers of the worst places beside them, on the side that they face. The colours of all axes have one range.
// picture.values is ignored. Otherwise works as
// draw_pipeline().
PictureStatus draw_medial_errors(const std::filesystem::path& png, const MedialErrorsPicture& errors,
                                 const PipelinePicture& picture);

}  // namespace orchard
