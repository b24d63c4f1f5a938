#pragma once
#include <chrono>
#include <filesystem>
#include <string>

#include "orchard/geometry/progress.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/quality.h"
#include "orchard/viz/vtk_writer.h"

// The pipeline in one picture. Debian's VTK draws only on an X display, even offscreen, and aborts the process where
// there is none or where its OpenGL is broken. So the drawing is done by a small program of its own, `orchard-render`,
// on the files of write_pipeline(): whatever happens to it, the caller gets a status. (Drawing in a forked copy of
// the caller would be unsafe beside the threads of TBB and Embree.)
namespace orchard {

struct PipelinePicture {
  PipelineValues values;  // what is missing gets no panel: mesh, points, medial axis, three tree levels
  std::string title;      // above the panels; may be empty
  UpAxis up = UpAxis::y;  // the mesh's axis that points up in the picture
  // Where the eye is, in radians: from the model's front (z; -y where z is up) towards its right; above its middle.
  double azimuth = 0.6, elevation = 0.4;
  int width = 0;                      // pixels, 64 to 8192; 0: as wide as the model and its captions need
  int height = 0;                     // likewise; 0: 560 for each row of panels
  std::chrono::seconds timeout{120};  // for drawing; a picture takes a few seconds
  std::filesystem::path renderer;     // empty: $ORCHARD_RENDER, beside the running program, then in PATH
  Progress progress;                  // asked every few milliseconds, without a fraction worth showing
};

struct PictureStatus {
  bool made = false;
  std::string reason;  // why there is no picture, in one line
  explicit operator bool() const { return made; }
};

// Why nothing can be drawn or shown, in one line that says what to do: orchard-render is not there, or cannot be run.
// Empty where it can.
std::string renderer_missing(const PipelinePicture& picture = {});

// Draws a .png. Uses the display of $DISPLAY; where that is unset or does not serve, starts Xvfb from PATH for the time
// of the picture. Never throws for want of a display, a renderer, a writable file or time, never prints, and leaves
// neither processes nor temporary files behind; not when it throws Cancelled either, which is all that it throws. Safe
// to call from several threads.
PictureStatus draw_pipeline(const std::filesystem::path& png, const PipelinePicture& picture);

// Where a medial axis is bad.
struct MedialErrorsPicture {
  const Surface* surface = nullptr;
  const SurfaceSampling* sampling = nullptr;  // points of the surface at which coverage is shown
  const MedialMesh* mesh = nullptr;
  std::vector<double> coverage;    // of each point, in % of the diagonal
  std::vector<double> protrusion;  // at each vertex of the medial mesh, the most of the balls around it; likewise
  std::vector<WorstPlace> worst;   // numbered from 1 on
};

// As draw_pipeline(): the surface coloured by coverage and the axis by protrusion, each from the front and from behind,
// with the numbers of the worst places on the side that they face. picture.values do not count.
PictureStatus draw_medial_errors(const std::filesystem::path& png, const MedialErrorsPicture& errors,
                                 const PipelinePicture& picture);

}  // namespace orchard
