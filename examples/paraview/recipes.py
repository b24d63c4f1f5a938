"""The recipes of docs/guide/paraview.md as a script: pvbatch recipes.py FOLDER RECIPE [-o PICTURE.png]

FOLDER has what `orchard medial MODEL` and `orchard build MODEL` wrote. RECIPE is threshold, color, clip, transparent, spheres or
animate, or all, which draws each of them as PICTURE-RECIPE.png. Each function does the steps of the recipe of its name.
"""
import argparse
import glob
import os

from paraview import simple

TO_EYE, UP = (0.52, 0.39, 0.76), (0, 1, 0)  # from the right and above


def model_in(folder):
    """FOLDER/MODEL."""
    (axis,) = glob.glob(os.path.join(folder, "*-medial.vtu"))
    return axis[: -len("-medial.vtu")]


def axis_of(model):
    return simple.XMLUnstructuredGridReader(FileName=[model + "-medial.vtu"])


def polydata(file):
    return simple.XMLPolyDataReader(FileName=[file])


def color_by(shown, view, kind, array, title, labels=True):
    simple.ColorBy(shown, (kind, array))
    shown.RescaleTransferFunctionToDataRange(False, True)
    colors = simple.GetColorTransferFunction(array)
    colors.ApplyPreset("Viridis (matplotlib)", True)
    bar = simple.GetScalarBar(colors, view)
    bar.Title, bar.ComponentTitle, bar.TitleColor, bar.LabelColor = title, "", [0.1] * 3, [0.1] * 3
    bar.TitleFontSize, bar.LabelFontSize, bar.ScalarBarLength, bar.ScalarBarThickness = 15, 14, 0.6, 14
    bar.WindowLocation, bar.Position, bar.AddRangeLabels = "Any Location", [0.86, 0.2], 0
    bar.RangeLabelFormat = bar.LabelFormat = "%.3g"
    shown.SetScalarBarVisibility(view, labels)


def show_glass(model, view, opacity=0.15):
    """A transparent mesh around an axis or a tree."""
    shown = simple.Show(polydata(model + "-medial-mesh.vtp"), view)
    shown.Representation = "Surface"
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = [0.55, 0.62, 0.70]
    shown.Opacity = opacity


def threshold(model, view):
    """The important sheets: faces whose two contacts lie far apart."""
    kept = simple.Threshold(Input=axis_of(model))
    kept.Scalars = ["CELLS", "contact_angle"]
    kept.LowerThreshold, kept.UpperThreshold = 60, 180
    color_by(simple.Show(kept, view), view, "CELLS", "contact_angle", "contact_angle (degrees)")
    show_glass(model, view)


def color(model, view):
    """The local thickness on the surface."""
    shown = simple.Show(polydata(model + "-medial-thickness.vtp"), view)
    color_by(shown, view, "POINTS", "thickness", "thickness (mesh units)")


def clip(model, view):
    """The front half of the mesh is cut away; the axis is inside."""
    cut = simple.Clip(Input=polydata(model + "-medial-mesh.vtp"))
    cut.ClipType = "Plane"
    low = cut.Input.GetDataInformation().GetBounds()
    cut.ClipType.Origin = [(low[0] + low[1]) / 2, (low[2] + low[3]) / 2, (low[4] + low[5]) / 2]
    cut.ClipType.Normal = [0, 0, 1]
    cut.Invert = 1
    shown = simple.Show(cut, view)
    shown.ColorArrayName = ["POINTS", ""]
    shown.AmbientColor = shown.DiffuseColor = [0.80, 0.83, 0.87]
    color_by(simple.Show(axis_of(model), view), view, "POINTS", "radius", "radius (mesh units)")


def transparent(model, view):
    """The axis by radius in its transparent solid, with borders and seams."""
    color_by(simple.Show(axis_of(model), view), view, "POINTS", "radius", "radius (mesh units)")
    lines = simple.Show(polydata(model + "-medial-structure.vtp"), view)
    lines.ColorArrayName = ["POINTS", ""]
    lines.AmbientColor = lines.DiffuseColor = [0.1] * 3
    lines.LineWidth = 2
    show_glass(model, view, 0.2)


def show_spheres(model, level, view, labels=True):
    shown = simple.Show(polydata(f"{model}-build-level-{level}.vtp"), view)
    shown.SetRepresentationType("3D Glyphs")
    shown.GlyphType = "Sphere"
    shown.GlyphType.ThetaResolution = shown.GlyphType.PhiResolution = 24
    shown.Scaling = 1
    shown.ScaleMode = "Magnitude"
    shown.SelectScaleArray = "radius"
    shown.ScaleFactor = 2  # ParaView's sphere has radius 1/2
    color_by(shown, view, "POINTS", "radius", "radius (mesh units)", labels)


def spheres(model, view):
    """The spheres of a level of the tree."""
    show_spheres(model, 2, view)
    show_glass(model, view)


RECIPES = {recipe.__name__: recipe for recipe in (threshold, color, clip, transparent, spheres)}


def new_view(model, size):
    """A view on a white ground that shows the whole model."""
    view = simple.CreateView("RenderView")
    view.ViewSize = size
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    mesh = polydata(model + "-medial-mesh.vtp")
    mesh.UpdatePipeline()
    low = mesh.GetDataInformation().GetBounds()
    center = [(low[0] + low[1]) / 2, (low[2] + low[3]) / 2, (low[4] + low[5]) / 2]
    radius = sum((low[2 * k + 1] - low[2 * k]) ** 2 for k in range(3)) ** 0.5 / 2
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = center
    view.CameraPosition = [c + 4 * radius * d for c, d in zip(center, TO_EYE)]
    view.CameraViewUp = UP
    view.CameraParallelScale = radius * max(0.8, size[1] / size[0])
    return view


def draw(recipe, model, picture, size):
    view = new_view(model, size)
    RECIPES[recipe](model, view)
    simple.Render(view)
    simple.SaveScreenshot(picture, view, ImageResolution=size, CompressionLevel="9")
    simple.Delete(view)


def animate(model, picture, size):
    """The levels of the tree, which are steps of time in MODEL-build.pvd: three of them beside each other."""
    layout = simple.CreateLayout("levels")
    left = layout.SplitHorizontal(0, 1 / 3)
    right = layout.SplitHorizontal(left + 1, 1 / 2)
    for cell, level in ((left, 0), (right, 1), (right + 1, 2)):
        view = new_view(model, [size[0] // 3, size[1]])
        view.CameraParallelScale = 1.1 * view.CameraParallelScale
        simple.AssignViewToLayout(view, layout, cell)
        show_spheres(model, level, view, labels=False)
        show_glass(model, view)
        simple.Render(view)
    simple.SaveScreenshot(picture, layout, ImageResolution=size, CompressionLevel="9")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("recipe", choices=[*RECIPES, "animate", "all"])
    parser.add_argument("-o", "--output", default="picture.png")
    parser.add_argument("--size", type=int, nargs=2, default=[500, 340])
    options = parser.parse_args()
    model = model_in(options.folder)
    simple._DisableFirstRenderCameraReset()
    stem, ending = os.path.splitext(options.output)
    for recipe in [*RECIPES, "animate"] if options.recipe == "all" else [options.recipe]:
        picture = f"{stem}-{recipe}{ending}" if options.recipe == "all" else options.output
        if recipe == "animate":
            animate(model, picture, [options.size[0], options.size[1] * 2 // 3])
        else:
            draw(recipe, model, picture, options.size)
        print(picture)


main()
