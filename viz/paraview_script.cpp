#include "paraview_script.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/xml_escaped.h"
#include "vtk_data.h"

namespace orchard::detail {
namespace {

// The part of the script that is the same for every model. The lines before it set what differs.
constexpr const char* kScript = R"PY(
def arguments():
    parser = argparse.ArgumentParser(description="A level of the sphere-tree around the mesh.")
    parser.add_argument("-o", "--output", help="save a picture (.png) here")
    parser.add_argument("--level", type=int, default=LAST_LEVEL, help="of the tree (the last one)")
    parser.add_argument("--size", type=int, nargs=2, default=[1200, 900], help="of the picture, in pixels")
    return parser.parse_known_args()[0]


def show_mesh(view):
    mesh = simple.XMLPolyDataReader(registrationName="mesh", FileName=[os.path.join(FOLDER, PREFIX + "-mesh.vtp")])
    shown = simple.Show(mesh, view)
    shown.Representation = "Surface"
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = [0.55, 0.62, 0.70]
    shown.Opacity = 0.25
    return mesh


def show_spheres(view):
    levels = simple.PVDReader(registrationName="levels", FileName=os.path.join(FOLDER, PREFIX + ".pvd"))
    shown = simple.Show(levels, view)
    as_spheres(shown, 32)
    simple.ColorBy(shown, ("POINTS", COLOR))
    colors = simple.GetColorTransferFunction(COLOR)
    colors.ApplyPreset("Viridis (matplotlib)", True)
    colors.AutomaticRescaleRangeMode = "Clamp and update every timestep"
    bar = simple.GetScalarBar(colors, view)
    bar.Title, bar.ComponentTitle, bar.TitleColor, bar.LabelColor = COLOR, "", [0.1] * 3, [0.1] * 3
    bar.TitleFontSize, bar.LabelFontSize, bar.ScalarBarLength, bar.ScalarBarThickness = 14, 12, 0.3, 12
    bar.RangeLabelFormat = bar.LabelFormat = "%.3g"
    shown.SetScalarBarVisibility(view, True)
    return levels, shown


def main():
    options = arguments()
    view = white_view()
    show_mesh(view)
    if LAST_LEVEL >= 0:
        levels, shown = show_spheres(view)
        scene = simple.GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        scene.PlayMode = "Snap To TimeSteps"
        scene.AnimationTime = max(0, min(options.level, LAST_LEVEL))
        view.ViewTime = scene.AnimationTime
        levels.UpdatePipeline(scene.AnimationTime)
        shown.RescaleTransferFunctionToDataRange(False, True)
    look(view, options)


main()
)PY";

bool measured(const SphereTree& tree) {
  return std::all_of(tree.nodes.begin(), tree.nodes.end(),
                     [](const SphereNode& node) { return std::isfinite(node.inaccuracy); });
}

}  // namespace

const char* const kScriptBegin = R"PY(
import argparse
import os
import sys

from paraview import simple


def own_path():
    """Where this file is. ParaView's window does not say it to the script that it was started with."""
    if "__file__" in globals():
        return os.path.abspath(__file__)
    with open("/proc/self/cmdline", encoding="utf-8", errors="surrogateescape") as words:
        return os.path.abspath(words.read().partition("\0--script")[2][1:].partition("\0")[0])


FOLDER = os.path.dirname(own_path())


def white_view():
    simple._DisableFirstRenderCameraReset()  # which would step back further than the model needs
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesLabelColor = [0.1] * 3
    return view


def as_spheres(shown, corners):
    """Draws points as spheres of their radius, each of so many corners around."""
    shown.SetRepresentationType("3D Glyphs")
    shown.GlyphType = "Sphere"
    shown.GlyphType.ThetaResolution = shown.GlyphType.PhiResolution = corners
    shown.Scaling = 1
    shown.ScaleMode = "Magnitude"
    shown.SelectScaleArray = "radius"
    shown.ScaleFactor = 2  # ParaView's sphere has radius 1/2


def look(view, options, *example):
    """Turns the camera to the model, and saves the picture if one is named."""
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = CENTER
    view.CameraPosition = [c + 4 * RADIUS * d for c, d in zip(CENTER, TO_EYE)]
    view.CameraViewUp = UP
    view.CameraParallelScale = HALF_HEIGHT
    simple.Render(view)
    if options.output:
        simple.SaveScreenshot(options.output, view, ImageResolution=options.size)
    elif os.path.basename(sys.executable or sys.argv[0]).startswith("pvbatch"):
        print("name a picture: pvbatch", os.path.basename(own_path()), *example, "-o picture.png")

)PY";

std::string python_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string python_list(const Vector& v) {
  return "[" + python_number(v.x()) + ", " + python_number(v.y()) + ", " + python_number(v.z()) + "]";
}

std::string python_quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

Vector towards_eye(UpAxis up) {
  constexpr double kAzimuth = 0.6, kElevation = 0.4;
  const int axis = static_cast<int>(up);
  const Vector upward = Vector::Unit(axis);
  const Vector front = up == UpAxis::z ? Vector(-Vector::UnitY()) : Vector(Vector::Unit((axis + 1) % 3));
  return std::cos(kElevation) * (std::cos(kAzimuth) * front + std::sin(kAzimuth) * upward.cross(front)) +
         std::sin(kElevation) * upward;
}

ParaViewScene paraview_scene(const PipelineValues& values) {
  const Sphere& ball = values.surface->bounding_ball();
  ParaViewScene scene{ball.center,
                      ball.radius,
                      kParaViewRoom * ball.radius,
                      towards_eye(values.up),
                      Vector::Unit(static_cast<int>(values.up)),
                      {}};
  if (values.tree) scene.color = measured(*values.tree) ? "inaccuracy" : "radius";
  return scene;
}

void write_levels_in_time(const std::filesystem::path& prefix, Index depth) {
  write_file(with_ending(prefix, ".pvd"), [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
           "  <Collection>\n";
    for (Index level = 0; level <= depth; ++level)
      out << "    <DataSet timestep=\"" << level << "\" part=\"0\" file=\""
          << xml_escaped(prefix.filename().string() + "-level-" + std::to_string(level) + ".vtp") << "\"/>\n";
    out << "  </Collection>\n</VTKFile>\n";
  });
}

void write_paraview_script(const std::filesystem::path& prefix, const PipelineValues& values) {
  const ParaViewScene scene = paraview_scene(values);
  const std::string name = prefix.filename().string();
  std::string text = "\"\"\"What ParaView shows of " + name + ": paraview --script=" + name +
                     "-view.py, or without a window\npvbatch " + name +
                     "-view.py -o picture.png [--level K]. In ParaView the levels are steps of time.\n\"\"\"\n";
  text += "PREFIX = " + python_quoted(name) + "\n";
  text += "CENTER, RADIUS = " + python_list(scene.center) + ", " + python_number(scene.radius) + "\n";
  text += "HALF_HEIGHT = " + python_number(scene.half_height) + "\n";
  text += "TO_EYE, UP = " + python_list(scene.to_eye) + ", " + python_list(scene.up) + "\n";
  text += "LAST_LEVEL = " + (values.tree ? std::to_string(values.tree->depth()) : std::string("-1")) + "\n";
  if (values.tree) text += "COLOR = " + python_quoted(scene.color) + "\n";
  write_file(with_ending(prefix, "-view.py"), text + kScriptBegin + kScript);
}

}  // namespace orchard::detail
