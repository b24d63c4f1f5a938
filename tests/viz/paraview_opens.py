"""Opens orchard's own files in ParaView by its plugin, and looks at what the script beside the views drew.

paraview_opens.py PLUGIN.py FOLDER    FOLDER: lamp.orchard, .sph, .ma, a .vor, lamp-build.pvd, lamp-build.pvsm and view.png,
of --level 1
"""
import glob
import os
import runpy
import sys

import numpy
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def fetched(source, time=None):
    source.UpdatePipeline() if time is None else source.UpdatePipeline(time)
    return simple.servermanager.Fetch(source)


def values(data, name):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


def check_trees(folder):
    packed = simple.OpenDataFile(os.path.join(folder, "lamp.orchard"))
    text = simple.OpenDataFile(os.path.join(folder, "lamp.sph"))
    for tree in (packed, text):
        tree.Resolution = 0
    for level in (0, 1, 2):
        packed.Level = text.Level = level
        a, b = fetched(packed), fetched(text)
        reader = simple.XMLPolyDataReader(FileName=[os.path.join(folder, f"lamp-build-level-{level}.vtp")])
        written = fetched(reader)
        for data in (a, b):
            assert data.GetNumberOfPoints() == written.GetNumberOfPoints()
            for name, tolerance in (("radius", 1e-5), ("node", 0), ("parent", 0), ("branch", 0), ("carried", 0)):
                assert numpy.allclose(values(data, name), values(written, name), rtol=tolerance, atol=tolerance), name
            centers = [vtk_to_numpy(x.GetPoints().GetData()) for x in (data, written)]
            assert numpy.allclose(*centers, atol=1e-5)
        # What is stored is not below what was measured, but for the last bits.
        assert (values(a, "error") >= values(written, "error") * (1 - 1e-5)).all()
    packed.Level, packed.Resolution = 1, 8
    surfaces = fetched(packed)
    spheres = fetched(text).GetNumberOfPoints()
    assert surfaces.GetNumberOfPolys() % spheres != 1 and surfaces.GetNumberOfPolys() > 100
    packed.LevelsInTime, packed.Resolution = 1, 0
    assert [fetched(packed, time).GetNumberOfPoints() for time in (0, 1)][0] == 1


def check_levels_in_time(folder):
    levels = simple.PVDReader(FileName=os.path.join(folder, "lamp-build.pvd"))
    assert list(levels.TimestepValues) == [0, 1, 2]
    counts = [fetched(levels, time).GetNumberOfPoints() for time in (0, 1, 2)]
    assert counts[0] == 1 and counts[0] < counts[1] < counts[2], counts


def check_axis_and_diagram(folder):
    axis = fetched(simple.OpenDataFile(os.path.join(folder, "lamp.ma")))
    with open(os.path.join(folder, "lamp.ma"), encoding="utf-8") as file:
        vertices, _, triangles = (int(word) for word in file.readline().split()[:3])
    assert axis.GetNumberOfPoints() == vertices and axis.GetNumberOfPolys() == triangles
    assert (values(axis, "radius") >= 0).all()
    # Every vertex and cell has a part of the structure.
    assert (values(axis, "structure") >= 0).all() and set(values(axis, "structure_kind")) <= {0, 1, 2, 3, 4}
    cells = vtk_to_numpy(axis.GetCellData().GetArray("structure_kind"))
    assert len(cells) == axis.GetNumberOfCells() and (cells[-triangles:] == 0).all()
    diagram = simple.OpenDataFile(glob.glob(os.path.join(folder, "*.vor"))[0])
    drawn = fetched(diagram)
    assert drawn.GetNumberOfPoints() > 300 and drawn.GetNumberOfLines() > drawn.GetNumberOfPoints()
    diagram.Points = 1
    assert fetched(diagram).GetNumberOfPoints() >= 300


def check_picture(file):
    """Where something was drawn."""
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    image = reader.GetOutput()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())[:, :3].astype(int)
    drawn = (pixels < 240).any(axis=1)
    colors = len(numpy.unique(pixels // 16, axis=0))
    assert image.GetDimensions()[:2] == (1200, 900) and 0.05 < drawn.mean() < 0.9 and colors > 30, (drawn.mean(), colors)
    return drawn


def check_state(folder, of_script):
    """The state shows what the script does: the last level at first, and the others as time goes."""
    simple.ResetSession()
    simple.LoadState(os.path.join(folder, "lamp-build.pvsm"))
    (view,) = simple.GetViews()
    scene = simple.GetAnimationScene()
    assert sorted(name for name, _ in simple.GetSources()) == ["levels", "mesh"] and scene.AnimationTime == 2
    glyphs = simple.GetDisplayProperties(simple.FindSource("levels"), view).GetProperty("GlyphType").Available
    assert len(glyphs) > 5 and "Sphere" in glyphs, glyphs
    scene.AnimationTime = 1
    picture = os.path.join(folder, "state.png")
    simple.SaveScreenshot(picture, view, ImageResolution=[1200, 900])
    drawn = check_picture(picture)
    overlap = (drawn & of_script).sum() / (drawn | of_script).sum()
    assert overlap > 0.99, overlap


def check_worst_places(folder):
    """Every system's axis in its mesh, with its worst places, side by side."""
    simple.ResetSession()
    simple.LoadState(os.path.join(folder, "axes/out/lamp-worst.pvsm"))
    names = {name for name, _ in simple.GetSources()}
    assert {"mesh", "other at 100: axis", "other at 100: worst places", "orchard-raw at 100: axis"} <= names, names
    (layout,) = simple.GetLayouts().values()
    assert len(simple.GetViews()) == 2
    picture = os.path.join(folder, "worst.png")
    simple.SaveScreenshot(picture, layout, ImageResolution=[1200, 900])
    drawn = check_picture(picture).reshape(900, -1)
    assert drawn[:, :500].any() and drawn[:, -500:].any()


def main():
    plugin, folder = sys.argv[1:]
    runpy.run_path(plugin, run_name="__main__")  # the way that works in Debian's ParaView, too
    check_trees(folder)
    check_levels_in_time(folder)
    check_axis_and_diagram(folder)
    check_state(folder, check_picture(os.path.join(folder, "view.png")))
    check_worst_places(folder)
    print("ParaView opens all of it")


main()
