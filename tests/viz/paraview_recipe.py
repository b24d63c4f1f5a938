"""Does in ParaView what the README says to do, with the settings as they stand there, and measures the picture.

paraview_recipe.py README.md VIEWS.vtm LEVEL.vtp PICTURE.png
"""
import re
import sys

import numpy
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

PIXELS = 700


def settings(readme):
    """The settings of the recipe: *Name* value or *Name* `value`."""
    recipe = next(part for part in readme.split("\n\n") if "*3D Glyphs*" in part).replace("\n", " ")
    found = dict(re.findall(r"\*(Glyph Type|Scale Mode|Scale Array|Scale Factor)\* `?([\w.]*\w)`?", recipe))
    assert len(found) == 4, f"the recipe does not name all four settings: {found}"
    return found


def check_views(file):
    views = simple.OpenDataFile(file)
    views.UpdatePipeline()
    data = simple.servermanager.Fetch(views)
    blocks = [data.GetBlock(i) for i in range(data.GetNumberOfBlocks())]
    assert len(blocks) >= 6 and all(block.GetNumberOfPoints() > 0 for block in blocks), blocks


def pixels(file):
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3].astype(int)


def main():
    readme, views, level, picture = sys.argv[1:]
    recipe = settings(open(readme).read())
    simple._DisableFirstRenderCameraReset()
    check_views(views)

    source = simple.OpenDataFile(level)
    view = simple.CreateView("RenderView")
    view.ViewSize = [PIXELS, PIXELS]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    shown = simple.Show(source, view)
    shown.SetRepresentationType("3D Glyphs")
    shown.GlyphType = recipe["Glyph Type"]
    shown.Scaling = 1
    shown.ScaleMode = recipe["Scale Mode"]
    shown.SelectScaleArray = recipe["Scale Array"]
    shown.ScaleFactor = float(recipe["Scale Factor"])
    if recipe["Glyph Type"] == "Sphere":  # as round as the comparison below is strict
        shown.GlyphType.ThetaResolution = shown.GlyphType.PhiResolution = 40
    shown.Specular = 0

    source.UpdatePipeline()
    data = simple.servermanager.Fetch(source)
    centers = vtk_to_numpy(data.GetPoints().GetData())
    radii = vtk_to_numpy(data.GetPointData().GetArray("radius"))
    low, high = (centers - radii[:, None]).min(0), (centers + radii[:, None]).max(0)
    middle, half = (low + high) / 2, 0.55 * (high - low)[:2].max()
    view.CameraParallelProjection = 1
    view.CameraParallelScale = half
    view.CameraFocalPoint = middle
    view.CameraPosition = middle + [0, 0, 20 * half]
    view.CameraViewUp = [0, 1, 0]
    simple.Render(view)
    simple.SaveScreenshot(picture, view, ImageResolution=[PIXELS, PIXELS])

    # Where the tree's balls are, seen along z, against where something was drawn.
    image = pixels(picture)
    drawn = (image < 250).any(axis=2)
    axis = (numpy.arange(PIXELS) + 0.5) / PIXELS * 2 * half - half
    x, y = numpy.meshgrid(axis + middle[0], axis + middle[1])
    wanted = numpy.zeros_like(drawn)
    for center, radius in zip(centers, radii):
        wanted |= (x - center[0]) ** 2 + (y - center[1]) ** 2 <= radius**2
    overlap = (drawn & wanted).sum() / (drawn | wanted).sum()
    print(f"{len(radii)} spheres; drawn and wanted agree on {overlap:.4f} of their pixels")
    assert overlap > 0.98, "this picture does not show the spheres of the tree"


main()
