#pragma once
#include <filesystem>
#include <string>

#include "orchard/viz/vtk_writer.h"

namespace orchard::detail {

constexpr double kParaViewRoom = 1.15;  // the spheres of the first levels are larger than the mesh

// From the right and above, as in the picture.
Vector towards_eye(UpAxis up);

// The beginning of every script: its imports, own_path() and FOLDER, which is the script's folder, white_view(),
// as_spheres() and look(), for which the script sets CENTER, RADIUS, HALF_HEIGHT, TO_EYE and UP.
extern const char* const kScriptBegin;

// Return values in the syntax of Python.
std::string python_number(double value);
std::string python_list(const Vector& v);
std::string python_quoted(const std::string& text);

// The view of ParaView, and the array by which the spheres of a level are coloured.
struct ParaViewScene {
  Vector center;
  double radius = 0, half_height = 0;  // of the mesh, and of the picture
  Vector to_eye, up;
  std::string color;  // empty without a tree
};

// Precondition: values.surface.
ParaViewScene paraview_scene(const PipelineValues& values);

// Writes PREFIX.pvd: the levels of a tree as the steps of an animation, level k at time k.
void write_levels_in_time(const std::filesystem::path& prefix, Index depth);

// Writes PREFIX-view.py, which shows the files of write_pipeline() next to it without further settings.
void write_paraview_script(const std::filesystem::path& prefix, const PipelineValues& values);

}  // namespace orchard::detail
