"""What is made of solids and their medial axes: curve skeletons, parts of the surface, offsets."""
from __future__ import annotations

import dataclasses
import math
import os
import typing

from . import _construction
from ._arrays import Anything, Floats, Indices, choice, number, view, whole
from ._mesh import Mesh
from ._progress import Progress

PathLike = typing.Union[str, "os.PathLike[str]"]
_FORMATS = ("swc", "graphml", "obj", "csv")


@dataclasses.dataclass(frozen=True)
class Curve:
    """A curve of a skeleton between two nodes. A closed curve without another node has one vertex as both ends."""

    start: int  #: a vertex of the skeleton: a node
    end: int
    length: float  #: mesh units
    min_radius: float
    mean_radius: float
    significance: float  #: the largest one along it, in mesh units; infinite for loops
    of_axis: bool  #: whether all of it is a curve of the axis too
    vertices: Indices  #: of the skeleton, ends included


@dataclasses.dataclass(frozen=True, repr=False)
class Skeleton:
    """The curves that a medial axis is reduced to: MedialAxis.skeleton(). Lengths are in mesh units."""

    vertices: Floats  #: (k, 3)
    radii: Floats  #: (k,): the exact distances to the surface
    burn_times: Floats  #: (k,): the times at which the fire of the sheets reaches the vertices
    edges: Indices  #: (e, 2)
    nodes: Indices  #: vertices at which curves end or meet, and points without curves
    sheets: Indices  #: (s, 3): triangles of closed sheets around cavities, which no curve can replace
    curves: list[Curve]
    edge_length: float  #: the longest edge of the complex that burned
    max_moved: float  #: the farthest that straightening moved a vertex
    axis_distance: float  #: proven: no place of the skeleton is farther from the axis
    _handle: _construction.CurveSkeleton

    def topology(self) -> dict[str, int]:
        """Its components, loops and cavities: those of the axis."""
        return self._handle.topology()

    def text(self, format: str) -> str:
        """The text that the command writes: swc, graphml, obj or csv."""
        return self._handle.text(choice("format", format, _FORMATS))

    def save(self, file: PathLike) -> None:
        """Writes .swc, .graphml, .obj or .csv."""
        path = os.fspath(file)
        ending = os.path.splitext(path)[1].lower()[1:]
        text = self.text(choice("the ending of file", ending, _FORMATS))
        with open(path, "w", encoding="utf-8") as target:
            target.write(text)

    def __repr__(self) -> str:
        return f"<Skeleton: {len(self.curves)} curves, {len(self.vertices)} vertices>"


@dataclasses.dataclass(frozen=True, repr=False)
class SurfaceParts:
    """The parts of a surface by its medial axis: MedialAxis.segment()."""

    mesh: Mesh  #: the mesh with its long edges divided; the vertices of the solid's own mesh come first
    of_face: Indices  #: (m,): the solid's triangle that each face is a piece of
    part_of_face: Indices  #: (m,): the part of each face
    radii: Floats  #: (m,): of the ball that touches the middle of each face
    parts: list[dict[str, typing.Any]]  #: the largest first: area, faces, patches, max_radius, sheet, region
    necks: list[dict[str, typing.Any]]  #: those that cut, the most significant first: regions, place, radius, significance
    regions: int  #: of the axis between necks
    _handle: _construction.SurfaceParts

    def part_mesh(self, part: int) -> Mesh:
        """A part as a mesh of its own, open at its seams."""
        return Mesh._of(self._handle.part_mesh(whole("part", part, 0, len(self.parts) - 1)), f"part {part}")

    def __repr__(self) -> str:
        return f"<SurfaceParts: {len(self.parts)} parts of {len(self.part_of_face)} faces>"


@dataclasses.dataclass(frozen=True, repr=False)
class Offset:
    """An offset with proven bounds. Lengths are in mesh units."""

    mesh: Mesh  #: closed; of hollow() the solid itself and its cavity
    distance: float  #: from the surface, that the offset or the cavity was made for
    tolerance: float
    cell: float  #: the edge length of the grid's cells
    min_distance: float  #: proven: no place of the offset, or of the cavity, is nearer to the surface
    max_distance: float  #: proven: none is farther
    nearest: Floats  #: the places that were found nearest and farthest
    farthest: Floats
    min_wall: float | None = None  #: proven, of hollow(): the wall is nowhere thinner

    @property
    def error(self) -> float:
        """The largest difference between the distance of a place and the one that was asked for."""
        return max(self.max_distance - self.distance, self.distance - self.min_distance)

    def __repr__(self) -> str:
        return f"<Offset by {self.distance:.6g}: {len(self.mesh.faces)} faces, error {self.error:.3g}>"


def skeleton_of(axis: _construction.MedialAxis, erosion: float, ratio: float, edge: float, straighten: int,
                progress: Progress) -> Skeleton:
    found = _construction.skeleton(axis, number("erosion", erosion, 0, 100) / 100, number("ratio", ratio, 0.2, 0.99),
                                   number("edge", edge, 0.01, 10) / 100, whole("straighten", straighten, 0, 1000),
                                   progress)
    curves = [Curve(**{**arc, "vertices": view(arc["vertices"])}) for arc in found.arcs()]
    return Skeleton(view(found.vertices()), view(found.radii()), view(found.burn_times()), view(found.edges()),
                    view(found.nodes()), view(found.sheets()), curves, *found.bounds(), found)


def parts_of(axis: _construction.MedialAxis, by: str, neck: float, min_area: float, faces: int, seam_rounds: int,
             progress: Progress) -> SurfaceParts:
    found = _construction.surface_parts(axis, choice("by", by, ("both", "sheets", "necks")), number("neck", neck, 0, 1),
                                        number("min_area", min_area, 0, 100) / 100,
                                        whole("faces", faces, 1, 100_000_000),
                                        whole("seam_rounds", seam_rounds, 0, 1000), progress)
    return SurfaceParts(Mesh._of(found.mesh(), "parts"), view(found.of_face()), view(found.part_of_face()),
                        view(found.radii()), found.parts(), found.necks(), found.regions(), found)


def _offset(found: dict[str, typing.Any], name: str) -> Offset:
    mesh = Mesh._of(found.pop("mesh"), name)
    return Offset(mesh=mesh, **found)


def offset(mesh: Anything, distance: float, *, side: str = "outside", tolerance: float = 0.5, strict: bool = False,
           progress: Progress = None) -> Offset:
    """The solid grown by a distance in mesh units ("outside"), shrunk ("inside"), or a shell that reaches this far to
    either side of the surface ("both"), which may be open. tolerance: the largest error, in percent of the diagonal.

    >>> from orchard_geometry import box_mesh
    >>> grown = offset(box_mesh([1, 1, 1]), 0.2, tolerance=2)
    >>> bool(grown.mesh.solid and grown.error <= grown.tolerance)
    True
    """
    chosen = choice("side", side, ("outside", "inside", "both"))
    given = Mesh.of(mesh)
    surface = given._surface if chosen == "both" else given._solid(strict, progress)
    return _offset(_construction.offset(surface, number("distance", distance, 1e-12, math.inf), chosen,
                                        number("tolerance", tolerance, 0.02, 50) / 100, progress), "offset")


def hollow(mesh: Anything, wall: float, *, tolerance: float = 0.5, strict: bool = False,
           progress: Progress = None) -> Offset:
    """The solid with a cavity: walls are `wall` (mesh units) thick or a little more, and parts thinner than two walls
    stay solid. tolerance: as offset()."""
    surface = Mesh.of(mesh)._solid(strict, progress)
    return _offset(_construction.hollow(surface, number("wall", wall, 1e-12, math.inf),
                                        number("tolerance", tolerance, 0.02, 50) / 100, progress), "hollow")
