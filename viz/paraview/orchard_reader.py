"""A ParaView plugin that opens orchard's own files: sphere-trees (.orchard, .sph), medial meshes (.ma) and Voronoi
diagrams (.vor). Formats: docs/reference/formats.md. Needs numpy, which ParaView brings.

Load it with "paraview --script=orchard_reader.py", or in the Python shell and in scripts of pvbatch with
runpy.run_path("orchard_reader.py", run_name="__main__"). Tools > Manage Plugins > Load New and LoadPlugin() work as well,
but not in the ParaView of Debian 12, which says "invalid ELF header": its own support for plugins in Python asks for a
function that Python 3.11 does not have any more. As a script, this file provides that function first.
"""
import inspect
import os

if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

import numpy
from paraview.util.vtkAlgorithm import VTKPythonAlgorithmBase, smdomain, smhint, smproperty, smproxy
from paraview.vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

MAGIC, VERSION, BLOCK_BYTES, LEAF = b"\x89ORCH\r\n\x1a", 4, 224, 0x80000000


class Tree:
    """Nodes in breadth-first order: centers (n x 3), radii, errors (NaN: not known), levels, parents, leaves."""

    def __init__(self, centers, radii, errors, levels, parents, leaves):
        # Infinity, as files have it, would make one colour of all others.
        self.centers, self.radii, self.errors = centers, radii, numpy.where(numpy.isfinite(errors), errors, numpy.nan)
        self.levels, self.parents, self.leaves = levels, parents, leaves

    def branches(self):
        """The child of the root that each node descends from, counted from 0; -1 for the root."""
        branches = numpy.full(len(self.radii), -1)
        first = None
        for node in range(1, len(branches)):
            parent = self.parents[node]
            if parent == 0:
                first = node if first is None else first
                branches[node] = node - first
            else:
                branches[node] = branches[parent]
        return branches


def read_orchard(name):
    data = numpy.fromfile(name, dtype=numpy.uint8)
    if len(data) < 320 or data[:8].tobytes() != MAGIC:
        raise ValueError(f"{name}: not an .orchard file")
    version, = data[8:12].view("<u4")
    if version != VERSION:
        raise ValueError(f"{name}: version {version}; this plugin reads version {VERSION}")
    if data[24:32].view("<u8")[0] != len(data):
        raise ValueError(f"{name}: its length is not what its header says")
    branching, origin = int(data[32:36].view("<u4")[0]), data[48:72].view("<f8")
    offset, count = (int(x) for x in data[104:120].view("<u8"))
    blocks = data[offset:offset + count * BLOCK_BYTES].reshape(count, BLOCK_BYTES)
    floats, links = blocks[:, :192].copy().view("<f4").reshape(count, 6, 8), blocks[:, 192:].copy().view("<u4")
    bits = (branching - 1).bit_length()
    places, levels, parents, leaves = [(0, 0)], [0], [-1], []
    node = 0
    while node < len(places):
        link = int(links[places[node]])
        leaves.append(link >= LEAF)
        if link < LEAF:
            children, first = (link & ((1 << bits) - 1)) + 1, link >> bits
            for child in range(children):
                places.append((first + child // 8, child % 8))
                levels.append(levels[node] + 1)
                parents.append(node)
        node += 1
    at = numpy.array(places)
    values = floats[at[:, 0], :, at[:, 1]].astype(float)
    return Tree(values[:, :3] + origin, values[:, 3], values[:, 5], numpy.array(levels), numpy.array(parents),
                numpy.array(leaves))


def lines_of(name):
    with open(name, encoding="utf-8", errors="replace") as file:
        for line in file:
            words = line.split()
            if words and not words[0].startswith("#"):
                yield words


def read_sph(name):
    lines = lines_of(name)
    levels, branching = (int(word) for word in next(lines)[:2])
    wanted = sum(branching**level for level in range(levels))
    rows = [[float(word) for word in words[:4]] for _, words in zip(range(wanted), lines)]
    number, place = {}, []  # of the nodes that are used, among all of the complete tree
    for i, row in enumerate(rows):
        if row[3] > 0:
            number[i] = len(place)
            place.append(i)
    parents = [number[(i - 1) // branching] if i > 0 else -1 for i in place]
    depth = []
    for parent in parents:
        depth.append(0 if parent < 0 else depth[parent] + 1)
    leaves = numpy.ones(len(place), bool)
    leaves[[parent for parent in parents if parent >= 0]] = False
    table = numpy.array([rows[i] for i in place]).reshape(-1, 4)
    return Tree(table[:, :3], table[:, 3], numpy.full(len(place), numpy.inf), numpy.array(depth), numpy.array(parents),
                leaves)


def structure_of(words, counts):
    """Part and kind of each vertex, edge and triangle by the structure section; None where there is none. A vertex has
    the part of the least dimension that it is in."""
    try:
        numbers = [int(word) for word in words]
        at, parts = 1, []
        for _ in range(numbers[0]):
            number, kind, count = numbers[at:at + 3]
            parts.append((kind, number, numbers[at + 3:at + 3 + count]))
            at += 3 + count
        if not parts or len(numbers) != at:
            return None
        of = [numpy.full((count, 2), -1) for count in counts]  # of vertices, edges, triangles
        for kind, number, cells in sorted(parts, key=lambda part: part[0] == 3):
            of[0 if kind == 3 else 2 if kind == 0 else 1][cells] = number, kind
        return of
    except (ValueError, IndexError):
        return None


def spread_to_vertices(of, edges, triangles):
    junctions = of[0][:, 0] >= 0
    for cells, own in ((triangles, of[2]), (edges, of[1])):
        for cell, value in zip(cells, own):
            if value[0] < 0:
                continue
            for vertex in cell:
                if not junctions[vertex]:
                    of[0][vertex] = value


def read_ma(name):
    """Centers, radii, edges that no triangle has, triangles, and their arrays structure and structure_kind: of points, and
    of the edges and triangles. Deleted cells are left out."""
    lines = lines_of(name)
    counts = [int(word) for word in next(lines)[:3]]
    vertices, edges, triangles, gone, rest = [], [], [], set(), []
    for words in lines:
        if words[0] not in ("v", "e", "f"):
            rest += words
            continue
        flags = words[{"v": 5, "e": 3, "f": 4}.get(words[0], len(words)):]
        deleted = flags[{"v": 1, "e": 1, "f": 0}.get(words[0], 0):][:1] == ["1"]
        if words[0] == "v":
            if deleted:
                gone.add(len(vertices))
            vertices.append([float(word) for word in words[1:5]])
        elif words[0] == "e" and not deleted:
            edges.append(tuple(int(word) for word in words[1:3]))
        elif words[0] == "f" and not deleted:
            triangles.append(tuple(int(word) for word in words[1:4]))
    whole = [len(vertices), len(edges), len(triangles)] == counts and not gone
    of = structure_of(rest, counts) if whole else None
    if len(vertices) != counts[0]:
        raise ValueError(f"{name}: {len(vertices)} vertices, and {counts[0]} promised")
    edges = [edge for edge in edges if not gone & set(edge)]
    triangles = [triangle for triangle in triangles if not gone & set(triangle)]
    of_triangles = {frozenset(pair) for a, b, c in triangles for pair in ((a, b), (b, c), (c, a))}
    table = numpy.array(vertices).reshape(-1, 4)
    curves = [i for i, edge in enumerate(edges) if frozenset(edge) not in of_triangles]
    arrays = None
    if of is not None:
        spread_to_vertices(of, edges, triangles)
        arrays = of[0], numpy.concatenate([of[1][curves], of[2]])
    return table[:, :3], table[:, 3], [edges[i] for i in curves], triangles, arrays


def read_vor(name):
    """Points, and the finite vertices: centers, radii, edges between them."""
    lines = lines_of(name)
    head = next(lines)
    if head[0] != "voronoi":
        raise ValueError(f"{name}: not a Voronoi diagram")
    points, rows = [], []
    for words in lines:
        if words[0] == "p":
            points.append([float(word) for word in words[1:4]])
        elif words[0] == "v":
            rows.append(([float(word) for word in words[1:4]], [int(word) for word in words[4:12]]))
    points = numpy.array(points).reshape(-1, 3)
    number = {}
    for i, (_, indices) in enumerate(rows):
        if min(indices[:4]) >= 0:
            number[i] = len(number)
    centers = numpy.array([rows[i][0] for i in number]).reshape(-1, 3)
    forming = numpy.array([rows[i][1][:4] for i in number], int).reshape(-1, 4)
    radii = numpy.linalg.norm(points[forming] - centers[:, None], axis=2).mean(axis=1)
    edges = [(number[i], number[j]) for i in number for j in rows[i][1][4:] if j in number and i < j]
    return points, centers, radii, edges


def cells_of(rows, size):
    cells = vtkCellArray()
    rows = numpy.asarray(rows, numpy.int64).reshape(-1, size)
    table = numpy.hstack([numpy.full((len(rows), 1), size, numpy.int64), rows])
    cells.ImportLegacyFormat(numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(table).ravel(), deep=1))
    return cells


def set_points(data, places):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(places, float), deep=1))
    data.SetPoints(points)


def add(arrays, name, values):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=1)
    array.SetName(name)
    arrays.AddArray(array)


def unit_sphere(resolution):
    """Corners and triangles of a sphere with 2 * resolution meridians."""
    theta = numpy.linspace(0, numpy.pi, resolution + 1)[1:-1]
    phi = numpy.linspace(0, 2 * numpy.pi, 2 * resolution, endpoint=False)
    ring = len(phi)
    corners = [(0, 0, 1)] + [(numpy.sin(t) * numpy.cos(p), numpy.sin(t) * numpy.sin(p), numpy.cos(t))
                             for t in theta for p in phi] + [(0, 0, -1)]
    triangles, last = [], len(corners) - 1
    for k in range(ring):
        following = (k + 1) % ring
        triangles.append((0, 1 + k, 1 + following))
        for row in range(len(theta) - 1):
            a, b = 1 + row * ring, 1 + (row + 1) * ring
            triangles += [(a + k, b + k, b + following), (a + k, b + following, a + following)]
        triangles.append((1 + (len(theta) - 1) * ring + following, 1 + (len(theta) - 1) * ring + k, last))
    return numpy.array(corners), numpy.array(triangles)


class Reader(VTKPythonAlgorithmBase):
    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkPolyData")
        self._name = None

    def set_name(self, name):
        if name != self._name:
            self._name = name
            self.Modified()


@smproxy.reader(name="OrchardTreeReader", label="orchard sphere-tree", extensions=["orchard", "sph"],
                file_description="orchard sphere-trees")
class OrchardTreeReader(Reader):
    """Spheres of a level: their centres as points with the arrays radius, error, level, node, parent, branch and carried
    (1 for a leaf of a level above), or, with a resolution, as surfaces. Where time is to go through the levels, level k is
    at the time k."""

    def __init__(self):
        super().__init__()
        self._level, self._resolution, self._in_time, self._tree = -1, 12, 0, None

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions=["orchard", "sph"], file_description="orchard sphere-trees")
    def SetFileName(self, name):
        self._tree = None
        self.set_name(name)

    @smproperty.intvector(name="Level", default_values=-1)
    @smdomain.intrange(min=-1, max=10)
    def SetLevel(self, level):
        """-1: the deepest."""
        self._level = level
        self.Modified()

    @smproperty.intvector(name="Resolution", default_values=12)
    @smdomain.intrange(min=0, max=64)
    def SetResolution(self, resolution):
        """Of the spheres' surfaces; 0: points, for glyphs of one's own."""
        self._resolution = resolution
        self.Modified()

    @smproperty.xml("""<IntVectorProperty name="LevelsInTime" command="SetLevelsInTime" number_of_elements="1"
        default_values="0"><BooleanDomain name="bool"/><Documentation>Whether the time says which level is shown.
        </Documentation></IntVectorProperty>""")
    def SetLevelsInTime(self, in_time):
        self._in_time = in_time
        self.Modified()

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        return [float(level) for level in range(self.tree().levels.max() + 1)] if self._name and self._in_time else []

    def tree(self):
        if self._tree is None:
            self._tree = read_sph(self._name) if self._name.lower().endswith(".sph") else read_orchard(self._name)
        return self._tree

    def RequestInformation(self, request, inputs, outputs):
        steps = self.GetTimestepValues()
        information = outputs.GetInformationObject(0)
        executive = self.GetExecutive()
        information.Remove(executive.TIME_STEPS())
        for step in steps:
            information.Append(executive.TIME_STEPS(), step)
        if steps:
            information.Append(executive.TIME_RANGE(), steps[0])
            information.Append(executive.TIME_RANGE(), steps[-1])
        return 1

    def level(self, outputs):
        deepest = int(self.tree().levels.max())
        if not self._in_time:
            return min(self._level, deepest) if self._level >= 0 else deepest
        information = outputs.GetInformationObject(0)
        key = self.GetExecutive().UPDATE_TIME_STEP()
        return int(min(max(information.Get(key), 0), deepest)) if information.Has(key) else deepest

    def RequestData(self, request, inputs, outputs):
        tree, level = self.tree(), self.level(outputs)
        shown = numpy.flatnonzero((tree.levels == level) | (tree.leaves & (tree.levels < level)))
        arrays = {"radius": tree.radii[shown], "error": tree.errors[shown], "level": tree.levels[shown], "node": shown,
                  "parent": tree.parents[shown], "branch": tree.branches()[shown],
                  "carried": (tree.levels[shown] < level).astype(int)}
        output = vtkPolyData.GetData(outputs, 0)
        if self._resolution < 3:
            set_points(output, tree.centers[shown])
            output.SetVerts(cells_of(numpy.arange(len(shown)), 1))
            copies = 1
        else:
            corners, triangles = unit_sphere(self._resolution)
            copies = len(corners)
            set_points(output, (tree.centers[shown][:, None] + tree.radii[shown][:, None, None] * corners).reshape(-1, 3))
            output.SetPolys(cells_of((triangles[None] + copies * numpy.arange(len(shown))[:, None, None]).reshape(-1, 3),
                                     3))
            add(output.GetPointData(), "Normals", numpy.tile(corners, (len(shown), 1)))
            output.GetPointData().SetActiveNormals("Normals")
        for name, values in arrays.items():
            add(output.GetPointData(), name, numpy.repeat(values, copies))
        return 1


@smproxy.reader(name="OrchardMedialReader", label="orchard medial mesh", extensions="ma",
                file_description="medial meshes")
class OrchardMedialReader(Reader):
    """Triangles and the edges that none has, with the point array radius and, where the file has them, structure and
    structure_kind (0 sheet, 1 seam, 2 border, 3 junction, 4 curve) of points and cells."""

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="ma", file_description="medial meshes")
    def SetFileName(self, name):
        self.set_name(name)

    def RequestData(self, request, inputs, outputs):
        centers, radii, edges, triangles, structure = read_ma(self._name)
        output = vtkPolyData.GetData(outputs, 0)
        set_points(output, centers)
        output.SetLines(cells_of(edges, 2))
        output.SetPolys(cells_of(triangles, 3))
        add(output.GetPointData(), "radius", radii)
        if structure is not None:
            for data, values in zip((output.GetPointData(), output.GetCellData()), structure):
                add(data, "structure", values[:, 0])
                add(data, "structure_kind", values[:, 1])
        return 1


@smproxy.reader(name="OrchardVoronoiReader", label="orchard Voronoi diagram", extensions="vor",
                file_description="Voronoi diagrams")
class OrchardVoronoiReader(Reader):
    """The finite vertices and the edges between them, with the point array radius; or the points."""

    def __init__(self):
        super().__init__()
        self._points = 0

    @smproperty.stringvector(name="FileName")
    @smdomain.filelist()
    @smhint.filechooser(extensions="vor", file_description="Voronoi diagrams")
    def SetFileName(self, name):
        self.set_name(name)

    @smproperty.xml("""<IntVectorProperty name="Points" command="SetPoints" number_of_elements="1" default_values="0">
        <BooleanDomain name="bool"/><Documentation>The points instead of the diagram.</Documentation>
        </IntVectorProperty>""")
    def SetPoints(self, points):
        self._points = points
        self.Modified()

    def RequestData(self, request, inputs, outputs):
        points, centers, radii, edges = read_vor(self._name)
        output = vtkPolyData.GetData(outputs, 0)
        if self._points:
            set_points(output, points)
            output.SetVerts(cells_of(numpy.arange(len(points)), 1))
            return 1
        set_points(output, centers)
        output.SetVerts(cells_of(numpy.arange(len(centers)), 1))
        output.SetLines(cells_of(edges, 2))
        add(output.GetPointData(), "radius", radii)
        return 1


def own_path():
    """Where this file is. ParaView's window does not say it to the script that it was started with."""
    if "__file__" in globals():
        return os.path.abspath(__file__)
    with open("/proc/self/cmdline", encoding="utf-8", errors="surrogateescape") as words:
        return os.path.abspath(words.read().partition("\0--script")[2][1:].partition("\0")[0])


if __name__ == "__main__":
    from paraview import simple
    simple.LoadPlugin(own_path(), remote=False, ns=globals())
