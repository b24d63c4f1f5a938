"""Values for VTK, which is imported when one is asked for. Of ParaView's own Python its VTK is used."""
from __future__ import annotations

import typing

import numpy

if typing.TYPE_CHECKING:
    from ._medial import MedialAxis
    from ._thickness import LocalThickness, Thickness
    from .runtime import Tree


def _modules() -> tuple[typing.Any, typing.Any, typing.Any]:
    """The classes of points and cells, and the conversion of arrays."""
    try:
        from vtkmodules.util import numpy_support
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    except ImportError as error:
        raise ImportError("this needs VTK for Python: the package python3-vtk9, or ParaView's own Python") from error
    return numpy_support, (vtkPoints, vtkCellArray), vtkPolyData


def add_array(data: typing.Any, name: str, values: typing.Any) -> None:
    """An array of points' or cells' data."""
    support, _, _ = _modules()
    array = numpy.asarray(values)
    if array.dtype.kind in "ui" and array.dtype.itemsize == 4:
        array = array.astype(numpy.int64)
    elif array.dtype.kind == "b":
        array = array.astype(numpy.int8)
    converted = support.numpy_to_vtk(numpy.array(array), deep=True)
    converted.SetName(name)
    data.AddArray(converted)


def _cells(rows: typing.Any) -> typing.Any:
    support, (_, cell_array), _ = _modules()
    rows = numpy.asarray(rows, dtype=numpy.int64)
    cells = cell_array()
    if len(rows):
        offsets = numpy.arange(len(rows) + 1, dtype=numpy.int64) * rows.shape[1]
        cells.SetData(support.numpy_to_vtkIdTypeArray(offsets, deep=True),
                      support.numpy_to_vtkIdTypeArray(numpy.ascontiguousarray(rows).ravel(), deep=True))
    return cells


def polydata(points: typing.Any, faces: typing.Any = None, lines: typing.Any = None,
             vertices: bool = False) -> typing.Any:
    """A vtkPolyData of points with triangles, lines, or a vertex each."""
    support, (vtk_points, _), vtk_polydata = _modules()
    places = vtk_points()
    places.SetData(support.numpy_to_vtk(numpy.array(points, dtype=numpy.float64), deep=True))
    data = vtk_polydata()
    data.SetPoints(places)
    if vertices:
        data.SetVerts(_cells(numpy.arange(len(points)).reshape(-1, 1)))
    if lines is not None and len(lines):
        data.SetLines(_cells(lines))
    if faces is not None and len(faces):
        data.SetPolys(_cells(faces))
    return data


def arrays_of_vtk(data: typing.Any) -> tuple[typing.Any, typing.Any]:
    """Points and triangles of a vtkPolyData, strips of triangles and polygons included."""
    support, _, _ = _modules()
    if data.GetNumberOfPoints() == 0:
        raise ValueError("the polydata has no points")
    points = support.vtk_to_numpy(data.GetPoints().GetData())
    if data.GetNumberOfStrips():
        raise ValueError("the polydata has strips of triangles: apply the filter Triangulate first")
    polygons = data.GetPolys()
    corners = support.vtk_to_numpy(polygons.GetConnectivityArray())
    sizes = numpy.diff(support.vtk_to_numpy(polygons.GetOffsetsArray()))
    if len(sizes) == 0:
        raise ValueError("the polydata has no triangles")
    if not (sizes == 3).all():
        raise ValueError(f"the polydata has {int((sizes != 3).sum())} polygons that are no triangles: apply the filter "
                         "Triangulate first")
    return points, corners.reshape(-1, 3)


def axis_to_vtk(axis: MedialAxis) -> typing.Any:
    """Faces, and edges that no face has. Arrays of points: radius, contact_angle (degrees), structure,
    structure_kind; of cells: structure, structure_kind, contact_angle (degrees), the least of the corners."""
    structure = axis.structure
    faces = axis.faces
    of_edge = structure.of_edge
    on_curve = numpy.zeros(len(axis.edges), bool)
    known = of_edge >= 0
    on_curve[known] = structure.kinds[of_edge[known]] == 4
    lines = axis.edges[on_curve]
    data = polydata(axis.vertices, faces, lines)
    angles = numpy.degrees(axis.contact_angle)
    add_array(data.GetPointData(), "radius", axis.radii)
    add_array(data.GetPointData(), "contact_angle", angles)
    add_array(data.GetPointData(), "structure", structure.of_vertex)
    add_array(data.GetPointData(), "structure_kind", structure.kinds[structure.of_vertex])
    # VTK has the cells in this order: lines before polygons.
    parts = numpy.concatenate([of_edge[on_curve], structure.of_face.astype(numpy.int64)])
    add_array(data.GetCellData(), "structure", parts)
    add_array(data.GetCellData(), "structure_kind", structure.kinds[parts])
    add_array(data.GetCellData(), "contact_angle",
              numpy.concatenate([angles[lines].min(axis=1, initial=360), angles[faces].min(axis=1, initial=360)]))
    return data


def tree_to_vtk(tree: Tree, level: int | None) -> typing.Any:
    """A vertex for each sphere of a level, or of all, with the arrays radius, error, level and parent."""
    chosen = slice(None)
    if level is not None:
        wanted = tree.depth + 1 + level if level < 0 else level
        first, last = (int(place) for place in numpy.searchsorted(tree.levels, [wanted, wanted + 1]))
        chosen = slice(first, last)
    spheres = tree.spheres()[chosen]
    data = spheres_to_vtk(spheres)
    errors = tree.errors[chosen]
    add_array(data.GetPointData(), "error", numpy.where(numpy.isfinite(errors), errors, numpy.nan))
    add_array(data.GetPointData(), "level", tree.levels[chosen])
    add_array(data.GetPointData(), "parent", tree.parents[chosen])
    return data


def spheres_to_vtk(spheres: typing.Any) -> typing.Any:
    """A vertex for each sphere with its radius."""
    data = polydata(spheres[:, :3], vertices=True)
    add_array(data.GetPointData(), "radius", spheres[:, 3])
    return data


def thickness_to_vtk(thickness: LocalThickness) -> typing.Any:
    """The divided mesh with the arrays thickness, ball_diameter and contact_angle (degrees) of points and cells."""
    data = polydata(thickness.mesh.vertices, thickness.mesh.faces)
    for target, values in ((data.GetPointData(), thickness.at_vertices), (data.GetCellData(), thickness.at_faces)):
        _add_thickness(target, values)
    return data


def _add_thickness(target: typing.Any, values: Thickness) -> None:
    add_array(target, "thickness", values.thickness)
    add_array(target, "ball_diameter", values.ball_diameter)
    add_array(target, "contact_angle", numpy.degrees(values.contact_angle))


def wrap_pyvista(data: typing.Any) -> typing.Any:
    """A pyvista object of a VTK one."""
    try:
        import pyvista
    except ImportError as error:
        raise ImportError("this needs pyvista, which is not installed; to_vtk() does without") from error
    return pyvista.wrap(data)
