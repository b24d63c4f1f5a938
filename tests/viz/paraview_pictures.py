"""Measures what paraview_medial.sh drew, and what ParaView shows of lamp-medial.vtm without a click.

paraview_pictures.py FOLDER
"""
import glob
import itertools
import os
import sys

import numpy
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def pixels(file):
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)


def drawn(image):
    return (image < 245).any(axis=1)


def check_files(files, count):
    """Each has something on a white ground, and no two are alike."""
    images = {os.path.basename(file): pixels(file) for file in files}
    assert len(images) == count, sorted(images)
    for name, image in images.items():
        assert 0.01 < drawn(image).mean() < 0.9, (name, drawn(image).mean())
    for (one, a), (other, b) in itertools.combinations(images.items(), 2):
        assert a.shape != b.shape or (abs(a - b).max(axis=1) > 30).mean() > 0.005, (one, other)
    return images


def has_color(image, color, tolerance=60):
    return (abs(image - numpy.array(color)).max(axis=1) < tolerance).any()


def picture_of(file, sources, camera):
    view = simple.CreateView("RenderView")
    view.ViewSize = [400, 300]
    view.OrientationAxesVisibility, view.UseColorPaletteForBackground, view.Background = 0, 0, [1, 1, 1]
    for source, color in sources:
        shown = simple.Show(source, view)
        shown.ColorArrayName = ["POINTS", ""]
        shown.Ambient, shown.Diffuse = 1, 0
        shown.AmbientColor = shown.DiffuseColor = color
    simple.ResetCamera(view) if camera is None else setattr(view, "CameraPosition", camera[0])
    if camera is not None:
        view.CameraFocalPoint, view.CameraViewUp, view.CameraParallelScale = camera[1:]
    simple.SaveScreenshot(file, view, ImageResolution=[400, 300])
    camera = [list(view.CameraPosition), list(view.CameraFocalPoint), list(view.CameraViewUp), view.CameraParallelScale]
    simple.Delete(view)
    return pixels(file), camera


def check_vtm(folder):
    """The lines of the solid leave most of the axis in view, and surround it."""
    simple._DisableFirstRenderCameraReset()
    whole = simple.OpenDataFile(os.path.join(folder, "lamp-medial.vtm"))
    whole.UpdatePipeline()
    data = simple.servermanager.Fetch(whole)
    names = [data.GetMetaData(i).Get(data.NAME()) for i in range(data.GetNumberOfBlocks())]
    assert names == ["outline of the solid", "medial faces", "structure graph"], names
    axis = simple.XMLPolyDataReader(FileName=[os.path.join(folder, "lamp-medial-faces.vtp")])
    lines = simple.XMLPolyDataReader(FileName=[os.path.join(folder, "lamp-medial-outline.vtp")])
    both, camera = picture_of(os.path.join(folder, "vtm.png"), [(whole, [0, 0, 0])], None)
    seen, _ = picture_of(os.path.join(folder, "seen.png"), [(lines, [0, 0, 1]), (axis, [1, 0, 0])], camera)
    alone, _ = picture_of(os.path.join(folder, "alone.png"), [(axis, [1, 0, 0])], camera)
    red = lambda image: (image[:, 0] > 200) & (image[:, 1] < 100) & (image[:, 2] < 100)
    share = (red(seen) & red(alone)).sum() / red(alone).sum()
    print(f"{share:.2f} of the axis is seen between the lines of the solid")
    assert share > 0.6, share
    assert drawn(both).sum() > drawn(alone).sum(), "the lines of the solid are drawn around it"


def main():
    (folder,) = sys.argv[1:]
    presets = check_files(glob.glob(os.path.join(folder, "preset-*.png")), 5)
    lines = presets["preset-lines.png"]
    assert has_color(lines, (0, 0, 0)) and has_color(lines, (0xD5, 0x5E, 0)), "borders black, seams orange"
    recipes = check_files(glob.glob(os.path.join(folder, "recipe-*.png")), 6)
    for name in recipes:
        size = os.path.getsize(os.path.join(folder, name))
        assert size < 60_000, (name, size)
    check_vtm(folder)
    print("all pictures are right")


main()
