#include "orchard/viz/medial_script.h"

#include "orchard/geometry/atomic_file.h"
#include "palette.h"
#include "paraview_script.h"

namespace orchard {

using namespace detail;

namespace {

// The part of the script that is the same for every model. It follows the lines that differ.
constexpr const char* kMedialScript = R"PY(
PRESETS = {
    "radius": "the axis by radius in its transparent solid",
    "sheets": "each sheet, seam and curve in a colour of its own",
    "importance": "faces whose two contacts lie at least --angle degrees apart",
    "lines": "borders black, seams orange and curves blue",
    "balls": "the balls as spheres, at most --balls of them",
}


def arguments():
    text = "\n".join(f"  {name:12}{what}" for name, what in PRESETS.items())
    parser = argparse.ArgumentParser(description="The medial axis " + NAME + ". Presets:\n" + text,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="save a picture (.png) here")
    parser.add_argument("--preset", choices=PRESETS, default="radius", help="what to show (radius)")
    parser.add_argument("--angle", type=float, default=60, help="of the preset importance, in degrees (60)")
    parser.add_argument("--balls", type=int, default=20000, help="most spheres that are drawn (20000)")
    parser.add_argument("--opacity", type=float, default=0.15, help="of the solid; 0 hides it (0.15)")
    parser.add_argument("--size", type=int, nargs=2, default=[1200, 900], help="of the picture, in pixels")
    return parser.parse_known_args()[0]


def file(ending):
    return [os.path.join(FOLDER, NAME + ending)]


def show_mesh(view, opacity):
    if opacity <= 0:
        return
    shown = simple.Show(simple.XMLPolyDataReader(registrationName="solid", FileName=file("-mesh.vtp")), view)
    shown.Representation = "Surface"
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = [0.55, 0.62, 0.70]
    shown.Opacity = opacity


def axis():
    return simple.XMLUnstructuredGridReader(registrationName="axis", FileName=file(".vtu"))


def color_by_value(shown, view, kind, array, title):
    simple.ColorBy(shown, (kind, array))
    colors = simple.GetColorTransferFunction(array)
    colors.ApplyPreset("Viridis (matplotlib)", True)
    shown.RescaleTransferFunctionToDataRange(False, True)
    bar = simple.GetScalarBar(colors, view)
    bar.Title, bar.ComponentTitle, bar.TitleColor, bar.LabelColor = title, "", [0.1] * 3, [0.1] * 3
    bar.TitleFontSize, bar.LabelFontSize, bar.ScalarBarLength, bar.ScalarBarThickness = 15, 14, 0.6, 14
    bar.WindowLocation, bar.Position, bar.AddRangeLabels = "Any Location", [0.86, 0.2], 0
    bar.LabelFormat = "%.3g"
    shown.SetScalarBarVisibility(view, True)


def color_by_number(shown, array, colors, count):
    """Each number has a colour of its own; they come again where there are more numbers than colours."""
    simple.ColorBy(shown, ("CELLS", array))
    table = simple.GetColorTransferFunction(array)
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for i in range(count) for text in (str(i), str(i))]
    table.IndexedColors = [part for i in range(count) for part in colors[i % len(colors)]]


def show_radius(view, options):
    color_by_value(simple.Show(axis(), view), view, "POINTS", "radius", "radius (mesh units)")


def show_sheets(view, options):
    source = axis()
    source.UpdatePipeline()
    count = int(source.CellData["structure"].GetRange()[1]) + 1
    color_by_number(simple.Show(source, view), "structure", DISTINCT, count)


def show_importance(view, options):
    kept = simple.Threshold(registrationName="important faces", Input=axis())
    kept.Scalars = ["CELLS", "contact_angle"]
    kept.LowerThreshold, kept.UpperThreshold = options.angle, 180
    color_by_value(simple.Show(kept, view), view, "CELLS", "contact_angle", "contact angle (degrees)")


def show_lines(view, options):
    lines = simple.XMLPolyDataReader(registrationName="borders and seams", FileName=file("-structure.vtp"))
    shown = simple.Show(lines, view)
    shown.LineWidth = 3
    color_by_number(shown, "kind", KINDS, 3)


def balls_to_draw(most):
    """The source of the balls; says which of them they are if they are not all."""
    light = 0 < LIGHT_BALLS and most < BALLS
    there = LIGHT_BALLS if light else BALLS
    ending = "-light.vtp" if light else "-vertices.vtp"
    source = simple.XMLPolyDataReader(registrationName="balls", FileName=file(ending))
    kept = "the largest of each region" if light else ""
    drawn = there
    if there > most:
        step = -(-there // max(1, most))
        source = simple.MaskPoints(registrationName="some balls", Input=source)
        source.OnRatio, source.MaximumNumberofPoints = step, there
        source.GenerateVertices = source.SingleVertexPerCell = 1
        drawn = -(-there // step)
        kept += (", of which " if light else "") + f"one in {step}"
    if drawn < BALLS:
        print(f"{drawn} of {BALLS} balls are drawn: {kept} (--balls {most})")
    return source


def show_balls(view, options):
    shown = simple.Show(balls_to_draw(options.balls), view)
    as_spheres(shown, 16)
    color_by_value(shown, view, "POINTS", "radius", "radius (mesh units)")


SHOW = {"radius": show_radius, "sheets": show_sheets, "importance": show_importance, "lines": show_lines,
        "balls": show_balls}


def main():
    options = arguments()
    view = white_view()
    if options.output:
        view.ViewSize = options.size
    show_mesh(view, options.opacity)
    SHOW[options.preset](view, options)
    look(view, options, "--preset", options.preset)


main()
)PY";

template <class Colors>
std::string python_colors(const Colors& colors) {
  std::string text = "[";
  for (const Color& color : colors)
    text += (text.size() > 1 ? ", " : "") + python_list(Vector(color[0], color[1], color[2]));
  return text + "]";
}

}  // namespace

void write_medial_script(const std::filesystem::path& py, const MedialScript& script) {
  const Vector to_eye = towards_eye(script.up), up = Vector::Unit(static_cast<int>(script.up));
  std::string text = "\"\"\"Shows the medial axis " + script.name + " in ParaView: paraview --script=" + script.name +
                     "-view.py, or\nwithout a window pvbatch " + script.name +
                     "-view.py --preset NAME -o picture.png. --help lists the presets.\n\"\"\"\n";
  text += "NAME = " + python_quoted(script.name) + "\n";
  text += "CENTER, RADIUS = " + python_list(script.ball.center) + ", " + python_number(script.ball.radius) + "\n";
  text += "HALF_HEIGHT = " + python_number(kParaViewRoom * script.ball.radius) + "\n";
  text += "TO_EYE, UP = " + python_list(to_eye) + ", " + python_list(up) + "\n";
  text += "BALLS, LIGHT_BALLS = " + std::to_string(script.balls) + ", " + std::to_string(script.light_balls) + "\n";
  text += "DISTINCT = " + python_colors(kDistinct) + "\n";
  // The kinds of arcs: 0 curve, 1 border, 2 seam.
  text += "KINDS = " + python_colors(std::array{kCurveColor, kBorderColor, kSeamColor}) + "\n";
  write_file(py, text + kScriptBegin + kMedialScript);
}

}  // namespace orchard
