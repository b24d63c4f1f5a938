#pragma once
#include <filesystem>
#include <string>

#include "orchard/viz/vtk_writer.h"

namespace orchard::detail {

constexpr double kParaViewRoom = 1.15;  // the spheres of the first levels reach further than the mesh

// From the right and above, as in the picture.
Vector towards_eye(UpAxis up);

// The beginning of every script: what it imports, own_path() and FOLDER, which is where it lies, white_view(),
// as_spheres() and look(), for which the script sets CENTER, RADIUS, HALF_HEIGHT, TO_EYE and UP.
extern const char* const kScriptBegin;

// Values as Python has them.
std::string python_number(double value);
std::string python_list(const Vector& v);
std::string python_quoted(const std::string& text);

// From where ParaView looks, at what, and the array of a level's file that the spheres' colour stands for.
struct ParaViewScene {
  Vector center;
  double radius = 0, half_height = 0;  // of the mesh; of the picture
  Vector to_eye, up;
  std::string color;  // empty without a tree
};

// Precondition: values.surface.
ParaViewScene paraview_scene(const PipelineValues& values);

// PREFIX.pvd: the levels of a tree as the steps of an animation, level k at the time k.
void write_levels_in_time(const std::filesystem::path& prefix, Index depth);

// PREFIX-view.py: what ParaView shows without a click, from the files of write_pipeline() beside it.
void write_paraview_script(const std::filesystem::path& prefix, const PipelineValues& values);

}  // namespace orchard::detail
