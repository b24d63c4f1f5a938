"""A ParaView plugin with orchard's filters, in the menu Filters > orchard: Medial Axis, Sphere Tree and Local Thickness of
any triangulated polydata. It needs the package orchard_geometry where ParaView's Python finds it (PYTHONPATH).

Load it with "paraview --script=orchard_filters.py", or in the Python shell and in scripts of pvbatch with
runpy.run_path("orchard_filters.py", run_name="__main__"). Tools > Manage Plugins > Load New and LoadPlugin() work as well,
but not in the ParaView of Debian 12, whose own support for plugins in Python asks for a function that Python 3.11 does
not have any more; as a script, this file provides that function first.
"""
import inspect
import os
import traceback
import warnings

if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smdomain, smhint, smproperty, smproxy
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkPolyData

CATEGORY = """<ShowInMenu category="orchard" />"""


class Filter(VTKPythonAlgorithmBase):
    """What the filters share: options by name, progress, and errors in ParaView's message window."""

    def __init__(self):
        super().__init__(nInputPorts=1, nOutputPorts=1, inputType="vtkPolyData", outputType="vtkPolyData")
        self.options = {}

    def put(self, name, value):
        if self.options.get(name) != value:
            self.options[name] = value
            self.Modified()

    def given(self, *names):
        return {name: self.options[name] for name in names if name in self.options}

    def progress(self, stage, fraction):
        self.SetProgressText(stage)
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()

    def RequestData(self, request, inputs, outputs):
        window = vtkOutputWindow.GetInstance()
        try:
            import orchard_geometry
        except ImportError as error:
            window.DisplayErrorText(f"orchard: {error}. Put the folder that has orchard_geometry into PYTHONPATH before "
                                    "ParaView starts.\n")
            return 0
        try:
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always", orchard_geometry.RepairWarning)
                mesh = orchard_geometry.Mesh.of(vtkPolyData.GetData(inputs[0], 0))
                found = self.build(orchard_geometry, mesh)
            for warning in said:
                if issubclass(warning.category, orchard_geometry.RepairWarning):
                    window.DisplayWarningText(f"orchard: {warning.message}\n")
            vtkPolyData.GetData(outputs, 0).ShallowCopy(found)
            return 1
        except orchard_geometry.Cancelled:
            return 0
        except (ValueError, orchard_geometry.OrchardError) as error:
            window.DisplayErrorText(f"orchard: {error}\n")
        except Exception:  # ParaView would print it where a user of the window does not look
            window.DisplayErrorText("orchard: " + traceback.format_exc())
        return 0


@smproxy.filter(name="OrchardMedialAxis", label="Medial Axis")
@smhint.xml(CATEGORY)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkPolyData"], composite_data_supported=False)
class MedialAxisFilter(Filter):
    """The medial axis of a solid: triangles, and edges that none has. Point arrays radius, contact_angle in degrees, and
    structure with structure_kind (0 sheet, 1 seam, 2 border, 3 junction, 4 curve), to colour by and to threshold;
    cell arrays structure, structure_kind and contact_angle, the least of the corners."""

    @smproperty.intvector(name="Samples", default_values=5000)
    @smdomain.intrange(min=20, max=50000)
    def SetSamples(self, value):
        """Surface points: more follow the shape better, and take longer."""
        self.put("samples", value)

    @smproperty.xml("""<IntVectorProperty name="Refine" command="SetRefine" number_of_elements="1" default_values="1">
        <BooleanDomain name="bool"/><Documentation>Whether balls are made exact and sheets end smoothly, or the axis stays
        as the Voronoi diagram has it.</Documentation></IntVectorProperty>""")
    def SetRefine(self, value):
        self.put("refine", bool(value))

    @smproperty.doublevector(name="BorderLoss", default_values=0.1)
    @smdomain.doublerange(min=0, max=2)
    def SetBorderLoss(self, value):
        """Percent of the diagonal that a sheet's border may lose of the surface: more cuts more spurs off."""
        self.put("border_loss", value)

    @smproperty.doublevector(name="FeatureLoss", default_values=0.165)
    @smdomain.doublerange(min=0.01, max=2)
    def SetFeatureLoss(self, value):
        """Percent of the diagonal: sheets reach to convex edges beyond which so much is lost otherwise."""
        self.put("feature_loss", value)

    @smproperty.doublevector(name="EdgeLength", default_values=3)
    @smdomain.doublerange(min=0.2, max=20)
    def SetEdgeLength(self, value):
        """Percent of the diagonal that edges of the axis are long."""
        self.put("edge_length", value)

    @smproperty.intvector(name="OpenRounds", default_values=1)
    @smdomain.intrange(min=0, max=5)
    def SetOpenRounds(self, value):
        """Times that points are added where the surface is left open: more resolve thin parts, and take longer."""
        self.put("open_rounds", value)

    @smproperty.doublevector(name="PruneAngle", default_values=0)
    @smdomain.doublerange(min=0, max=180)
    def SetPruneAngle(self, value):
        """Degrees: cuts spurs whose two contacts are nearer in angle."""
        self.put("prune_angle", value)

    @smproperty.intvector(name="Vertices", default_values=0)
    @smdomain.intrange(min=0, max=2000)
    def SetVertices(self, value):
        """The axis in so many balls at most; 0: all of them."""
        self.put("vertices", value)

    @smproperty.intvector(name="Seed", default_values=1)
    @smdomain.intrange(min=0, max=100)
    def SetSeed(self, value):
        """Of the random points."""
        self.put("seed", value)

    def build(self, orchard, mesh):
        names = ["samples", "refine", "prune_angle", "seed"]
        if self.options.get("refine", True):
            names += ["border_loss", "feature_loss", "edge_length", "open_rounds"]
        axis = orchard.medial_axis(mesh, progress=self.progress, **self.given(*names))
        if self.options.get("vertices", 0) > 0:
            axis = axis.simplify(self.options["vertices"], progress=self.progress)
        return axis.to_vtk()


@smproxy.filter(name="OrchardSphereTree", label="Sphere Tree")
@smhint.xml(CATEGORY)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkPolyData"], composite_data_supported=False)
class SphereTreeFilter(Filter):
    """A certified sphere-tree of a solid: the centres of a level's spheres as points with the arrays radius, error, level
    and parent. Show them as 3D Glyphs: spheres, scaled by the array radius with the factor 2."""

    @smproperty.intvector(name="Depth", default_values=3)
    @smdomain.intrange(min=1, max=6)
    def SetDepth(self, value):
        """Levels below the root."""
        self.put("depth", value)

    @smproperty.intvector(name="Branching", default_values=8)
    @smdomain.intrange(min=2, max=64)
    def SetBranching(self, value):
        """Children of a sphere, on average."""
        self.put("branching", value)

    @smproperty.xml("""<IntVectorProperty name="Effort" command="SetEffort" number_of_elements="1" default_values="1">
        <EnumerationDomain name="enum"><Entry value="0" text="low"/><Entry value="1" text="default"/>
        <Entry value="2" text="high"/></EnumerationDomain>
        <Documentation>How long to search for tighter spheres.</Documentation></IntVectorProperty>""")
    def SetEffort(self, value):
        self.put("effort", ("low", "default", "high")[value])

    @smproperty.intvector(name="Level", default_values=-1)
    @smdomain.intrange(min=-1, max=6)
    def SetLevel(self, value):
        """Which level is shown; -1: the last one."""
        self.put("level", value)

    @smproperty.intvector(name="Seed", default_values=1)
    @smdomain.intrange(min=0, max=100)
    def SetSeed(self, value):
        """Of all random choices."""
        self.put("seed", value)

    def build(self, orchard, mesh):
        tree = orchard.sphere_tree(mesh, progress=self.progress, **self.given("depth", "branching", "effort", "seed"))
        return tree.to_vtk(min(self.options.get("level", -1), tree.depth))


@smproxy.filter(name="OrchardLocalThickness", label="Local Thickness")
@smhint.xml(CATEGORY)
@smproperty.input(name="Input", port_index=0)
@smdomain.datatype(dataTypes=["vtkPolyData"], composite_data_supported=False)
class LocalThicknessFilter(Filter):
    """How thick a solid is: its mesh, long edges divided, with the arrays thickness (NaN where nothing faces the place),
    ball_diameter and contact_angle in degrees, of points and of cells, to threshold and to colour by."""

    @smproperty.intvector(name="Samples", default_values=20000)
    @smdomain.intrange(min=100, max=200000)
    def SetSamples(self, value):
        """Triangles that the surface is divided into, about."""
        self.put("samples", value)

    @smproperty.xml("""<IntVectorProperty name="Definition" command="SetDefinition" number_of_elements="1"
        default_values="0"><EnumerationDomain name="enum"><Entry value="0" text="largest ball"/>
        <Entry value="1" text="ray"/></EnumerationDomain>
        <Documentation>The diameter of the largest ball that touches the place, or the way of a ray inward.</Documentation>
        </IntVectorProperty>""")
    def SetDefinition(self, value):
        self.put("definition", ("ball", "ray")[value])

    @smproperty.doublevector(name="Facing", default_values=120)
    @smdomain.doublerange(min=0, max=180)
    def SetFacing(self, value):
        """Degrees from which the two ends of a diameter face each other."""
        self.put("facing", value)

    @smproperty.doublevector(name="Smooth", default_values=40)
    @smdomain.doublerange(min=0.01, max=90)
    def SetSmooth(self, value):
        """Degrees: edges that turn by less are those of a smooth surface."""
        self.put("smooth", value)

    def build(self, orchard, mesh):
        return orchard.local_thickness(mesh, progress=self.progress,
                                       **self.given("samples", "definition", "facing", "smooth")).to_vtk()


def own_path():
    """Where this file is. ParaView's window does not say it to the script that it was started with."""
    if "__file__" in globals():
        return os.path.abspath(__file__)
    with open("/proc/self/cmdline", encoding="utf-8", errors="surrogateescape") as words:
        return os.path.abspath(words.read().partition("\0--script")[2][1:].partition("\0")[0])


if __name__ == "__main__":
    from paraview import simple
    simple.LoadPlugin(own_path(), remote=False, ns=globals())
