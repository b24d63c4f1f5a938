"""The filters in ParaView itself, by pvbatch: skipped where there is no ParaView."""
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = '''
import runpy, sys
from paraview import simple, servermanager
from vtkmodules.util.numpy_support import vtk_to_numpy
found = runpy.run_path(sys.argv[1], run_name="__main__")
mesh = simple.OpenDataFile(sys.argv[2])
solid = simple.Triangulate(Input=simple.ExtractSurface(Input=mesh))
axis = servermanager.Fetch(found["MedialAxis"](Input=solid, Samples=600))
assert axis.GetNumberOfPolys() > 100, axis.GetNumberOfPolys()
for name in ("radius", "contact_angle", "structure", "structure_kind"):
    assert axis.GetPointData().GetArray(name).GetNumberOfTuples() == axis.GetNumberOfPoints(), name
assert axis.GetCellData().GetArray("structure").GetNumberOfTuples() == axis.GetNumberOfCells()
few = servermanager.Fetch(found["MedialAxis"](Input=solid, Samples=600, Vertices=40))
assert 0 < few.GetNumberOfPoints() <= 40
tree = servermanager.Fetch(found["SphereTree"](Input=solid, Depth=1, Effort="low"))
assert 1 < tree.GetNumberOfPoints() <= 8 and tree.GetPointData().GetArray("radius").GetRange()[0] > 0
thick = servermanager.Fetch(found["LocalThickness"](Input=solid, Samples=500))
assert vtk_to_numpy(thick.GetPointData().GetArray("ball_diameter")).max() > 0
plane = found["MedialAxis"](Input=simple.Triangulate(Input=simple.Plane()), Samples=100)
plane.UpdatePipeline()
print("all filters")
'''


@pytest.fixture(scope="module")
def paraview(tmp_path_factory, data):
    file = tmp_path_factory.mktemp("paraview") / "filters.py"
    file.write_text(SCRIPT)
    package = os.environ["PYTHONPATH"].split(os.pathsep)[0]
    done = subprocess.run([ROOT / "tools/paraview", "pvbatch", file, ROOT / "python/paraview/orchard_filters.py",
                           data / "ship.obj"], capture_output=True, text=True, timeout=900,
                          env=dict(os.environ, PYTHONPATH=package))
    if done.returncode == 3:
        pytest.skip(done.stderr.strip())
    return done


def test_filters_of_any_triangulated_polydata(paraview):
    assert "all filters" in paraview.stdout, paraview.stdout + paraview.stderr


def test_errors_are_said_in_the_message_window(paraview):
    assert "no closed manifold, even after repair" in paraview.stdout + paraview.stderr
